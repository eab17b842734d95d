// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/needle_insertion.hpp"

#include "stylet/sim/plan.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

namespace stylet {

Result<InsertionPlan> needle_insertion(const NeedleLoad& load, const Scenario& scenario, const Locator& locator,
                                       const std::string& where) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : locator.mesh().nodes) box.extend(x);
  const std::string place = fmt::format("{}, needle {}", where, load.name);
  const double far = (box.center() - load.tip_mm).norm() + box.diagonal().norm();
  const Vec3 from = load.tip_mm - far * load.direction;
  const Vec3 to = load.tip_mm + far * load.direction;
  const auto crossing = locator.first_entry(from, to);
  if (!crossing) {
    return input_error(place,
                       fmt::format("its line through ({:.1f}, {:.1f}, {:.1f}) mm misses the patient", load.tip_mm.x(),
                                   load.tip_mm.y(), load.tip_mm.z()),
                       "Give a plan of this patient, in the same coordinates");
  }
  const Vec3 entry = from + crossing->t * (to - from);
  const double depth = (load.tip_mm - entry).dot(load.direction);
  if (depth > deepest_mm(scenario)) {
    return input_error(
        place,
        fmt::format("its tip has to go {:.0f} mm deep, but the needle is {:.0f} mm long and reaches only "
                    "{:.0f} mm",
                    depth, scenario.needle.length_mm, deepest_mm(scenario)),
        "Use a longer needle (needle.length_mm)");
  }
  if (!load.seeds.empty() && depth < load.seeds.back().behind_tip_mm) {
    return input_error(place, fmt::format("its tip would be {:.1f} mm deep, and its train does not fit in", depth),
                       "Give a plan of this patient, in the same coordinates");
  }
  InsertionPlan plan;
  plan.entry_mm = std::array<double, 3>{entry.x(), entry.y(), entry.z()};
  plan.direction = std::array<double, 3>{load.direction.x(), load.direction.y(), load.direction.z()};
  plan.depth_mm = depth;
  return plan;
}

double drop_depth_mm(double depth_mm, const LoadedSeed& seed, double seed_length_mm) {
  return depth_mm - seed.behind_tip_mm - 0.5 * seed_length_mm;
}

}  // namespace stylet
