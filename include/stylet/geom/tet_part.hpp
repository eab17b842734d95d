// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// A tetrahedron ("part") inside a larger one ("whole"): barycentric coordinates of the part's corners in the whole
/// tetrahedron (4 × 4, one column per corner).
using TetPart = Eigen::Matrix4d;

/// Volume of the part / volume of the whole tetrahedron, ≥ 0.
double share_of_tet(const TetPart& part);

/// The part of a tetrahedron in which a linear function has values between two levels, cut into tetrahedra.
/// @param values of the function at the four corners, in any unit
/// @param low lower level, in the same unit
/// @param high upper level, in the same unit, high ≥ low
/// @return empty where the function takes no value between the levels; over adjoining intervals of levels the volume
///   shares add up to 1
std::vector<TetPart> parts_between(const Vec4& values, double low, double high);

}  // namespace stylet
