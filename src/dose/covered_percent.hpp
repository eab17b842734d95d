// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_grid.hpp"
#include "stylet/dose/structure_samples.hpp"

namespace stylet::dose {

/// Share [%] of a structure's volume that lies within a grid, whose places are moved by `shift` [mm].
inline double covered_percent(const StructureSamples& samples, const DoseGrid& grid, const Vec3& shift) {
  double inside = 0.0, all = 0.0;
  for (std::size_t p = 0; p < samples.points.size(); ++p) {
    all += samples.volume_mm3[p];
    if (grid.covers(samples.points[p] - shift)) inside += samples.volume_mm3[p];
  }
  return all > 0.0 ? 100.0 * inside / all : 0.0;
}

}  // namespace stylet::dose
