// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_plan.hpp"
#include "stylet/implant/implant.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// How far seeds lie from where they were planned. Lost seeds do not count.
struct SeedErrors {
  std::size_t seeds = 0;
  double mean_mm = 0.0;  ///< of the distances
  double p95_mm = 0.0;   ///< 95th percentile of the distances
  double largest_mm = 0.0;
  struct Axis {
    double mean_mm = 0.0;  ///< of the signed errors: to the left, to posterior, to superior
    double sd_mm = 0.0;    ///< their standard deviation
  };
  std::array<Axis, 3> axes{};  ///< x, y, z in LPS
};
SeedErrors seed_errors(std::span<const SeedHistory> seeds);

/// The errors of a part of the seeds.
struct PartErrors {
  std::string name;  ///< of a needle; or "base", "mid", "apex"
  SeedErrors errors;
};
/// One for each needle, in the order of the implant.
std::vector<PartErrors> errors_by_needle(const ImplantHistory& history);
/// The third of the planned seeds' extent in z in which each seed was planned: 0 superior ("base"), 1 middle ("mid"),
/// 2 inferior ("apex").
std::vector<std::size_t> thirds_of(const ImplantHistory& history);
inline constexpr std::array<const char*, 3> kThirds{"base", "mid", "apex"};
/// Of the superior, middle and inferior third of the planned seeds' extent in z. Parts without a seed are left out.
std::vector<PartErrors> errors_by_third(const ImplantHistory& history);

/// The causes that errors can have in a permanent or a temporary implant, in the order in which files and pages give
/// them.
std::vector<SeedCause> causes_of(Implant implant);

/// The implant as the images of the plan show it: each dwell position comes to rest where the tissue is that was there
/// at planning, and nothing has moved since. @param history of a temporary implant
ImplantHistory history_at_planning(const ImplantHistory& history);

/// The share of one cause in the errors of all seeds.
struct CauseOfErrors {
  SeedCause cause{};
  double mean_mm = 0.0;  ///< mean length of its part of the error
  Vec3 mean_vector_mm = Vec3::Zero();
};
/// One for each of causes_of() the kind of implant.
std::vector<CauseOfErrors> causes_of_errors(std::span<const SeedHistory> seeds);

/// The plan with the seeds where they have come to rest. Lost seeds are left out.
DosePlan delivered_plan(const DosePlan& plan, const ImplantHistory& history);

}  // namespace stylet
