// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/dose/dose_evaluation.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace stylet::results {

/// How much of each cube of a regular grid along the patient's axes a structure fills. The outermost cubes are empty.
struct StructureMask {
  std::array<int, 3> size{0, 0, 0};
  Vec3 origin_mm = Vec3::Zero();    ///< centre of the first cube, LPS
  double spacing_mm = 1.0;          ///< edge of a cube
  std::vector<std::uint8_t> share;  ///< (size) 0 … 255: empty … full, about; x varies fastest
};

/// The mask of a structure with contours, from the slabs for which its planes stand (sample_structure()). Empty for a
/// structure without contours, or with contours that cannot be sampled.
/// @param most_cubes size of the mask, about
std::optional<StructureMask> structure_mask(const StructureDose& structure, double most_cubes);

/// Triangles that enclose a structure.
struct StructureSurface {
  std::vector<float> points_mm;          ///< (3 × points) LPS
  std::vector<std::uint32_t> triangles;  ///< (3 × triangles) numbers of points
};

/// The surface where a mask is half full, with at most so many triangles, about.
StructureSurface mask_surface(const StructureMask& mask, double most_triangles);

}  // namespace stylet::results
