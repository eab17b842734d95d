// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// A tetrahedron inside another: barycentric coordinates of its corners in that one (4 × 4, one column each).
using TetPart = Eigen::Matrix4d;

/// The share of the whole tetrahedron that a part has, ≥ 0.
double share_of_tet(const TetPart& part);

/// The part of a tetrahedron in which a linear function lies between two levels, cut into tetrahedra.
/// @param values of the function at the corners, in any unit
/// @param low, high levels in the same unit, low ≤ high
/// @return none where the function lies nowhere between them; shares of parts between successive levels sum to 1
std::vector<TetPart> parts_between(const Vec4& values, double low, double high);

}  // namespace stylet
