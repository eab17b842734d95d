// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image_tables.hpp"
#include "stylet/imaging/moment.hpp"
#include "stylet/realtime/snapshot.hpp"
#include "stylet/serve/image_picture.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/scenario.hpp"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace stylet::serve {

class ImageMaker;

/// The patient whose pictures are made: of the open model, or of a recording.
struct ImageSubject {
  std::shared_ptr<const TetMesh> mesh;
  Scenario scenario;                            ///< with the tables of probe, ultrasound and X-ray
  std::vector<int> gland;                       ///< regions of the target
  std::shared_ptr<const DisplayField> field{};  ///< of the open model; null in a replay
  bool is_recorded = false;                     ///< the patient of a replay
};

/// The state of the loop that a picture needs.
struct LoopState {
  double time_s = 0.0;
  std::vector<TissueForce> forces;
  std::vector<std::vector<Vec3>> needles_mm;  ///< LPS, centrelines: of the moving needle, and of those at rest
  std::vector<ShownSeed> seeds;               ///< where they are now
};
/// The same without seeds.
LoopState loop_state(const Snapshot& snapshot);

/// Makes ultrasound and X-ray pictures of the newest moment, one after the other, in a thread of its own. Moments that
/// come while a picture is being made replace each other. The other calls come from one thread.
class ImageDesk {
 public:
  ImageDesk();

  /// Takes up another patient; the settings of the probe, scanner and C-arm become those of its scenario
  /// (ImageTables::open()).
  void open(ImageSubject patient);
  /// The kind of picture that the pages look at.
  void show(ShownImage shown);
  [[nodiscard]] ShownImage shown() const { return shown_; }
  /// Whether a companion wants pictures. It gets those that the pages look at; while they look at none, ultrasound of
  /// the scenario's array.
  void serve(bool companion);
  [[nodiscard]] bool serves_companion() const { return is_serving_; }
  /// Whether pictures are made.
  [[nodiscard]] bool is_busy() const { return shown_ != ShownImage::none || is_serving_; }
  /// ImageTables::set()
  Result<> set(const std::string& key, double value);
  /// ImageTables::track()
  void track(const std::optional<Pose>& pose);
  [[nodiscard]] bool is_tracked() const { return tables_.is_tracked(); }

  /// The newest moment of the loop.
  void take(LoopState state);
  /// The newest moment of a replay.
  /// @param probe where it was then, which holds until a page moves the probe; empty: there was none
  void take(Moment moment, const std::optional<ProbeSettings>& probe);
  /// Where the probe is, as set by the pages.
  [[nodiscard]] ProbeSettings probe() const;

  /// The newest picture; null if there is none since the last call.
  std::shared_ptr<const LiveImage> news();
  /// Why no picture can be made of this patient, or why its probe moves nothing in the pictures; the part that is being
  /// prepared; where the probe does not do what the tracker's pose says. Empty: all is well.
  struct Report {
    std::string problem, stage, probe_problem;
  };
  [[nodiscard]] Report report() const;

 private:
  using Clock = std::chrono::steady_clock;
  void run(const std::stop_token& stop);
  std::optional<Clock::time_point> take_turn(ImageMaker& maker, std::optional<ImageSubject>& opened,
                                             const std::stop_token& stop);
  void make_picture(ImageMaker& maker, std::variant<std::monostate, LoopState, Moment> state);
  [[nodiscard]] ShownImage kind() const;
  void change(const std::function<void()>& what);

  mutable std::mutex mutex_;  ///< guards the members below; this object's thread does not write shown_ and is_serving_
  std::condition_variable_any wake_;
  std::optional<ImageSubject> patient_;  ///< taken by the thread
  ImageTables tables_;
  ShownImage shown_ = ShownImage::none;
  bool is_serving_ = false;  ///< a companion wants pictures
  bool is_changed_ = false;  ///< the tables or the kind of picture
  std::variant<std::monostate, LoopState, Moment> newest_;
  std::shared_ptr<const LiveImage> made_;
  std::string problem_, stage_;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
