// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"
#include "stylet/implant/seed_history.hpp"
#include "stylet/sim/choices.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// The message to viewers of a live session about an implant that is being carried out (docs/live_protocol.md).
namespace stylet::serve {

/// A seed of the plan.
struct PlannedSeed {
  std::size_t number = 0;  ///< its position in DosePlan::sources
  Vec3 planned_mm = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  ///< towards the tip of its needle
  /// Depth of the base at which it is left at its planned place: pushed out of the tip, or passed by the tip.
  double drop_depth_mm = 0.0;
  double behind_tip_mm = 0.0;  ///< in the loaded needle, from the tip to its centre; 0 in a replay
};

/// A needle of the plan.
struct PlannedNeedle {
  std::string name;                ///< as in NeedleLoad
  std::string hole;                ///< hole of the template on its line; empty: there is none
  Vec3 entry_mm = Vec3::Zero();    ///< [mm] LPS, skin point on its line
  Vec3 direction = Vec3::UnitZ();  ///< unit vector LPS
  double depth_mm = 0.0;           ///< depth of the base at which the tip is at its planned place
  bool is_ready = false;           ///< its model is compiled, so that it can be chosen at once
  std::vector<PlannedSeed> seeds;  ///< from the tip on
};

/// The plan to follow. Without needles there is no plan.
struct LivePlan {
  std::vector<PlannedNeedle> needles;  ///< in the order of the procedure
  int current = -1;                    ///< needle that is in front of or in the patient; −1: one beside the plan
  double seed_length_mm = 0.0;
  double seed_diameter_mm = 0.0;
  double prescription_Gy = 0.0;  ///< 0: none is known
  std::string source;            ///< name of the source model
  SeedTechnique technique = SeedTechnique::pushed;
};

/// The dose of some seeds.
struct ImplantScore {
  std::size_t seeds = 0;            ///< how many seeds it counts
  double d90_Gy = 0.0;              ///< of the target
  double d90_percent = 0.0;         ///< of the prescribed dose; NaN without one
  double v100_percent = 0.0;        ///< of the target; NaN without a prescribed dose
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
