// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"
#include "stylet/implant/recorded_implant.hpp"
#include "stylet/sim/choices.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// The messages to viewers of a live session about an implant that is being carried out (docs/live_protocol.md).
namespace stylet::serve {

/// The plan to follow. Without needles there is no plan.
struct ShownPlan {
  RecordedPlan plan;
  SeedTechnique technique = SeedTechnique::pushed;
  std::vector<bool> ready{};  ///< needles whose model is compiled, so that they can be chosen at once; empty: none is
};

/// The dose of some seeds. A live session does not know how many acts were before it.
struct ImplantScore : RecordedScore {
  double took_ms = 0.0;             ///< wall-clock time from the change of the seeds to D90
  std::vector<JudgedGoal> goals{};  ///< empty until they are computed, some time after D90
};

/// The part of the implant that has been carried out so far.
struct LiveImplant {
  /// In the order in which they were dropped. The cause `aim` is where the hand held the needle; the causes of a seed
  /// add up to its error.
  std::vector<SeedHistory> seeds;
  std::size_t planned_seeds = 0;
  std::optional<ImplantScore> now;      ///< of the dropped seeds; empty until it is computed
  std::optional<ImplantScore> planned;  ///< of the plan; empty until it is computed
  /// A train is being left: depth of the base at which it was begun. Empty: none is.
  std::optional<double> train_from_mm{};
  bool is_computing = false;  ///< `now` belongs to fewer or more seeds than have been dropped
  ImplantTally tally{};       ///< of all needles so far
};

/// Where the dropped seeds are at this moment.
struct LiveSeeds {
  std::vector<Vec3> now_mm;  ///< [mm] LPS, in the order of LiveImplant::seeds
};

/// The dose around the target as a grid of points, in the tissue at rest.
struct LiveDose {
  std::array<std::uint32_t, 3> size{0, 0, 0};  ///< points along x, y, z
  Vec3 origin_mm = Vec3::Zero();               ///< [mm] LPS, the first point
  double spacing_mm = 1.0;
  double unit_percent = 0.1;            ///< percent of the prescribed dose that 1 in `values` stands for
  std::vector<std::uint16_t> values{};  ///< (x·y·z) x varies fastest; larger doses have the largest number
};

}  // namespace stylet::serve
