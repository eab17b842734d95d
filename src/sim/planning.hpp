// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"
#include "stylet/sim/model.hpp"

namespace stylet {

inline constexpr double kNeedleOutside_mm = 5.0;  ///< of the needle stays out of the patient, to be held

/// Largest depth [mm] of the base: what is left of the needle outside is held by the hand, and by the template if that
/// guides it.
double deepest_mm(const Scenario& scenario);

/// Centroid of a set of regions by volume [mm] LPS; the whole mesh when the set is empty.
Vec3 centroid(const TetMesh& mesh, const std::vector<int>& regions);

/// The line of a planned insertion: where it meets the skin and how deep it goes. A line that misses the patient is
/// refused.
Result<PlannedInsertion> plan_insertion(const InsertionPlan& plan, std::size_t number, const Scenario& scenario,
                                        const Locator& locator, const std::vector<int>& target,
                                        const std::string& where);

/// Displacement nodes of all elements within `radius` of the segment from `from` to `to`.
std::vector<Index> corridor_nodes(const Tissue& tissue, const Vec3& from, const Vec3& to, double radius_mm);

}  // namespace stylet
