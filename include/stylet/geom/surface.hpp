// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// A triangulated surface with normals that point outwards.
struct Surface {
  std::string name;
  std::vector<Vec3> points;  ///< [mm] LPS
  std::vector<std::array<Index, 3>> triangles;
};

/// Surfaces as lists of numbers, one surface after the other, as files have them.
struct FlatSurfaces {
  std::vector<float> points_mm;  ///< (3 × points) LPS
  std::vector<Index> triangles;  ///< (3 × triangles) numbers of points, from 0 for each surface
  std::vector<Index> sizes;      ///< (2 × surfaces) numbers of points and of triangles of each
};

FlatSurfaces flatten(std::span<const Surface> surfaces);

/// The surfaces that were made flat. @param names of the surfaces
/// @return empty where the sizes do not fit, a corner has no point, or a coordinate is NaN or beyond 1e6 mm
std::optional<std::vector<Surface>> unflatten(const FlatSurfaces& flat, std::span<const std::string> names);

}  // namespace stylet
