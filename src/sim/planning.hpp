// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/centroid.hpp"
#include "stylet/geom/locator.hpp"
#include "stylet/sim/plan.hpp"

namespace stylet {

inline constexpr double kNeedleOutside_mm = 5.0;  ///< of the needle stays out of the patient, to be held

/// Direction of a needle through a hole of the template: to superior.
inline const Vec3 kThroughTemplate = Vec3::UnitZ();

/// A point on the line of a needle through a hole, as far superior as the target's centre [mm] LPS. A hole that the
/// template does not have is refused.
Result<Vec3> point_behind_hole(const TemplateGrid& grid, const std::string& hole, const Vec3& target_centre);

/// The line of a planned insertion: where it meets the skin and how deep it goes. A line that misses the patient is
/// refused.
Result<PlannedInsertion> plan_insertion(const InsertionPlan& plan, std::size_t number, const Scenario& scenario,
                                        const Locator& locator, const std::vector<int>& target,
                                        const std::string& where);

/// Where compliance is computed before the start.
struct Corridor {
  std::vector<Index> elements;  ///< ascending
  std::vector<Index> nodes;     ///< of the mesh, those of the elements, way by way, each from its start to its end
  double radius_mm = 0.0;       ///< around the needles' lines, every element it meets is there
};

/// The elements within a radius of straight ways, or as many of the nearest as have `most_nodes` nodes.
/// @param ways [mm] LPS from, to
/// @param radius_mm at most this
Corridor find_corridor(const TetMesh& mesh, const std::vector<std::array<Vec3, 2>>& ways, double radius_mm,
                       int most_nodes);

}  // namespace stylet
