// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "folder_lock.hpp"
#include "image_desk.hpp"
#include "replay.hpp"
#include "replayed_seeds.hpp"
#include "room.hpp"
#include "scene.hpp"
#include "shelf.hpp"
#include "stylet/io/recorded_moments.hpp"

#include <utility>

namespace stylet::serve {

/// A recording that is shown: its scene, its needle, its seeds, and the moments for pictures. Requests: Desk::replay.
class ReplayRoom {
 public:
  explicit ReplayRoom(const SessionSettings& settings) : shelf_(settings.recordings, settings.archive) {}

  /// Names the recording to show, moves in the shown one, or wants the live needle back.
  Reply ask(const Request& request);
  /// Shows a recording from its start. Errors: it cannot be read or has no step; then a shown one stays.
  Result<Reply> enter(const std::string& name, const CaseList& cases);
  /// Ends the replay, if there is one.
  Reply leave();
  /// Advances the replay. @param dt_s [s] wall-clock time since the last call
  Reply tick(double dt_s, bool whole_curve);

  /// The patient of the recording, for pictures.
  [[nodiscard]] const ImageSubject& patient() const { return patient_; }
  /// The moment for pictures, and where the probe was then.
  [[nodiscard]] std::pair<Moment, std::optional<ProbeSettings>> moment() const;
  void describe(SessionStatus& status) const;

 private:
  Shelf shelf_;
  std::string name_;  ///< of the recording; empty: none is shown
  std::string hole_;
  std::unique_ptr<Replay> replay_;
  std::unique_ptr<ReplayedSeeds> seeds_;      ///< null: the recording has no implant
  std::unique_ptr<RecordedMoments> moments_;  ///< for pictures
  ImageSubject patient_;
  FolderLock in_use_;  ///< keeps the recording from being removed
  std::vector<std::string> inside_;
};

}  // namespace stylet::serve
