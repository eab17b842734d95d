// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/structure_slices.hpp"

namespace stylet::detail {

/// Whether a contour encloses something.
enum class ContourKind { sound, too_few_points, on_a_line };

/// Judges one contour by its points alone. Points on a line, or all at one place, enclose nothing.
ContourKind kind_of(const Contour& contour);

/// Area of a contour times the normal of its plane [mm²] (Newell).
Vec3 area_vector(const Contour& contour);

/// Checks that a contour that encloses something is planar and parallel to the others.
/// @param normal of the structure's slices @param place the contour, for the message
Result<> check_plane(const Contour& contour, const Vec3& normal, const std::string& place);

/// Normal of the plane that fits the points of a contour best.
Vec3 fitted_normal(const Contour& contour);

}  // namespace stylet::detail
