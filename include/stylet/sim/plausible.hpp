// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/scenario.hpp"

#include <string>
#include <vector>

namespace stylet {

/// Plausible range of a number of a scenario. The ranges of the table of keys say what is possible; a number outside
/// of these narrower ones is usually in another unit. docs/scenario.md shows the table.
struct PlausibleRange {
  std::string key;  ///< path of the key, as ScenarioKey::path
  double low = 0.0;
  double high = 0.0;         ///< in the key's unit; 0 itself is always plausible, since it switches something off
  std::string reason;        ///< where the bounds come from
  std::string below, above;  ///< the probable mistake, as advice; empty: no guess
};

/// All plausible ranges, in the order of the table of keys.
const std::vector<PlausibleRange>& plausible_ranges();

/// Warnings about a scenario that can be given before anything is computed, in complete sentences: numbers outside of
/// plausible_ranges(), angles that are probably in radians, needles that come from the head, and a run that would take
/// long. Values that equal the default are not doubted.
std::vector<std::string> warnings_before_start(const Scenario& scenario);

/// A warning about a needle that goes from superior to inferior; empty if it does not.
/// @param name of the insertion @param direction of the needle from base to tip, LPS
std::string from_the_head(const std::string& name, const Vec3& direction);

/// Estimate of the time and the memory that a computation takes, right within a factor of three.
struct WorkEstimate {
  double steps = 0.0;
  double preparation_s = 0.0;  ///< processor time until the first step
  double seconds = 0.0;        ///< processor time of preparation, steps, files and pictures
  double memory_GB = 0.0;      ///< at most at any time
};

/// Estimates the work of a scenario's insertions, or of its plan if it has no insertion. A depth that is found later
/// counts as 100 mm, a plan in a file as 20 needles. docs/scenario.md gives the figures and where they come from.
/// @param recorded_s [s] length of the recorded motions, which a scenario only names
WorkEstimate estimate_work(const Scenario& scenario, double recorded_s = 0.0);

/// Such as "about 2 minutes of processor time and 0.7 GB of memory".
std::string work_text(double seconds, double memory_GB);

/// A warning with the estimate and the cure if the work takes more than a quarter of an hour or much memory; empty if
/// not.
std::string long_work_warning(const Scenario& scenario, double recorded_s = 0.0);

}  // namespace stylet
