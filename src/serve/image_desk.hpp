// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/moment.hpp"
#include "stylet/realtime/snapshot.hpp"
#include "stylet/serve/image_picture.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/scenario.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace stylet::serve {

/// The patient whose pictures are made: of the open model, or of a recording.
struct ImageSubject {
  std::shared_ptr<const TetMesh> mesh;
  Scenario scenario;                            ///< with the tables of probe, ultrasound and X-ray
  std::vector<int> gland;                       ///< regions of the target
  std::shared_ptr<const DisplayField> field{};  ///< of the open model; null in a replay
  bool is_recorded = false;                     ///< the patient of a replay
};

/// Makes ultrasound and X-ray pictures of the newest moment, one after the other, in a thread of its own. Moments that
/// come while a picture is being made replace each other. The other calls come from one thread.
class ImageDesk {
 public:
  ImageDesk();
  ~ImageDesk();

  /// Takes up another patient; the settings of the probe, scanner and C-arm become those of its scenario. After a
  /// replay, those from before it are back.
  void open(ImageSubject patient);
  /// The kind of picture that the pages look at.
  void show(ShownImage shown);
  [[nodiscard]] ShownImage shown() const { return shown_; }
  /// Whether a companion wants pictures. It gets those that the pages look at; while they look at none, ultrasound of
  /// the scenario's array.
  void serve(bool companion);
  /// Whether pictures are made.
  [[nodiscard]] bool is_busy() const { return shown_ != ShownImage::none || is_serving_; }
  /// Sets a key of [probe], [ultrasound] or [fluoroscopy]. Errors: another key; a value out of range; a motion of the
  /// stepper while a tracker moves the probe.
  Result<> set(const std::string& key, double value);
  /// The pose to which a tracker moves the probe; empty: no tracker does, and the probe stays until set() moves it.
  void track(const std::optional<Pose>& pose);
  [[nodiscard]] bool is_tracked() const { return is_tracked_; }

  /// The newest moment of the loop. @param seeds where they are now
  void take(const Snapshot& snapshot, std::vector<ShownSeed> seeds);
  /// The newest moment of a replay.
  /// @param probe where it was then, which holds until a page moves the probe; empty: there was none
  void take(Moment moment, const std::optional<ProbeSettings>& probe);
  /// Where the probe is, as set by the pages.
  [[nodiscard]] ProbeSettings probe() const;

  /// The newest picture; null if there is none since the last call.
  std::shared_ptr<const LiveImage> news();
  /// Why no picture can be made of this patient, or why its probe moves nothing in the pictures; empty: all is well.
  [[nodiscard]] std::string problem() const;
  /// The part that is being prepared; empty: nothing.
  [[nodiscard]] std::string stage() const;
  /// Where the probe does not do what the tracker's pose says; empty: it does.
  [[nodiscard]] std::string probe_problem() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  ShownImage shown_ = ShownImage::none;
  bool is_serving_ = false;
  bool is_tracked_ = false;
};

}  // namespace stylet::serve
