// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet {

/// A triangulated surface with normals that point outwards.
struct Surface {
  std::string name;
  std::vector<Vec3> points;  ///< [mm] LPS
  std::vector<std::array<Index, 3>> triangles;
};

}  // namespace stylet
