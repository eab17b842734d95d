// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/probe/probe_place.hpp"
#include "stylet/sim/scenario.hpp"

#include <optional>
#include <string>
#include <utility>

namespace stylet::serve {

/// The tables of probe, scanner and X-ray unit that count for pictures: those of the open scenario, as pages, a tracker
/// or a recording have changed them. For one thread at a time.
class ImageTables {
 public:
  /// Takes up another patient. After a replay, the tables from before it are back.
  void open(const Scenario& scenario, bool is_recorded);
  /// Sets a key of [probe], [ultrasound] or [fluoroscopy]. Errors: another key; a value out of range; a motion of the
  /// stepper while a tracker moves the probe.
  Result<> set(const std::string& key, double value);
  /// The pose to which a tracker moves the probe; empty: no tracker does. @return whether it has changed
  bool track(const std::optional<Pose>& pose);
  /// Puts the probe where a recording has it, unless a page has moved it since the replay began.
  void take_recorded(const ProbeSettings& probe);
  /// Whether follow() has something to do.
  [[nodiscard]] bool is_moved() const { return is_moved_ && tracked_; }
  /// Moves the probe to the tracked pose. @param seat where the probe enters and rests, or why there is no such place
  void follow(const Result<ProbeSeat>& seat);

  [[nodiscard]] const Scenario& tables() const { return tables_; }
  [[nodiscard]] bool is_tracked() const { return tracked_.has_value(); }
  /// Where the probe does not do what the tracker's pose says; empty: it does.
  [[nodiscard]] const std::string& probe_problem() const { return probe_problem_; }

 private:
  Scenario tables_;   ///< as changed; in a replay with the recorded place of the probe
  Scenario planned_;  ///< of the open patient, as its file has it
  std::optional<std::pair<Scenario, Scenario>> set_aside_;  ///< both, of the live patient during a replay
  bool is_probe_moved_ = false;                             ///< by a page, during a replay
  std::optional<Pose> tracked_;
  bool is_moved_ = false;  ///< the tracked pose, or the patient, has changed
  std::string probe_problem_;
};

}  // namespace stylet::serve
