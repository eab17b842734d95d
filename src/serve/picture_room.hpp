// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image_desk.hpp"
#include "room.hpp"

#include <utility>

namespace stylet::serve {

/// The ultrasound and X-ray pictures of the patient that is on show, live or recorded, for pages and a companion.
/// Requests: Desk::pictures.
class PictureRoom {
 public:
  explicit PictureRoom(const SessionSettings& settings) : settings_(settings) {}

  Reply ask(const Request& request);
  /// Shows pictures of another patient; nothing changes if it is the same with the same field.
  void open(const ImageSubject& patient);
  /// Lets a companion have pictures and move the probe. Like the rest of what it sees, pictures are of the live needle.
  void serve_companion(bool is_live);
  /// Whether a companion gets pictures, which come at their rate also while nothing moves.
  [[nodiscard]] bool serves_companion() const { return desk_.serves_companion(); }
  /// Whether a moment is wanted at once, since pictures have been asked for or are of another patient.
  [[nodiscard]] bool wants_moment() { return std::exchange(wants_moment_, false); }
  /// The desk that makes the pictures, for moments and the place of the probe.
  [[nodiscard]] ImageDesk& desk() { return desk_; }
  /// A new picture, and the part of the status that is about pictures.
  Reply news(bool is_live);
  void describe(SessionStatus& status) const { status.image = told_; }

 private:
  const SessionSettings& settings_;
  ImageDesk desk_;
  std::pair<std::shared_ptr<const TetMesh>, std::shared_ptr<const DisplayField>> patient_;  ///< mesh and field
  bool wants_moment_ = false;
  SessionStatus::Image told_;
};

}  // namespace stylet::serve
