// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/centroid.hpp"
#include "stylet/geom/locator.hpp"
#include "stylet/sim/plan.hpp"

namespace stylet {

inline constexpr double kNeedleOutside_mm = 5.0;  ///< length of the needle that stays outside, for the hand

/// Direction of a needle through a hole of the template: to superior.
inline const Vec3 kThroughTemplate = Vec3::UnitZ();

/// The error with the scenario's name in front of its place.
inline Error within(const std::string& where, Error error) {
  error.where = where + ", " + error.where;
  return error;
}

/// Numbers of the regions that form the target: the gland, or else a planning volume, or else all unnamed labels.
std::vector<int> find_target(const TetMesh& mesh);

/// The point [mm] LPS on the line of a needle through a hole that is as far superior as the target's centre. Error: a
/// hole that the template does not have.
Result<Vec3> point_behind_hole(const TemplateGrid& grid, const std::string& hole, const Vec3& target_centre);

/// Plans an insertion: entry point on the skin, direction, depth and motion. Errors: a line that misses the patient, a
/// target beyond the needle's reach. @param number of the insertion in the scenario, from 0
Result<PlannedInsertion> plan_insertion(const InsertionPlan& plan, std::size_t number, const Scenario& scenario,
                                        const Locator& locator, const std::vector<int>& target,
                                        const std::string& where);

/// The part of the mesh for which compliance is computed before the start.
struct Corridor {
  std::vector<Index> elements;  ///< ascending
  std::vector<Index> nodes;     ///< their nodes in the mesh, sorted by way, then along the way
  double radius_mm = 0.0;       ///< around the needles' lines; the corridor has every element within it
};

/// Finds the elements within a radius of straight ways, or the nearest of them if they have more than `most_nodes`
/// nodes.
/// @param ways [mm] LPS, start and end of each
/// @param radius_mm largest radius of the corridor
Corridor find_corridor(const TetMesh& mesh, const std::vector<std::array<Vec3, 2>>& ways, double radius_mm,
                       int most_nodes);

}  // namespace stylet
