// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace stylet::results {

using Colour = std::array<double, 3>;  ///< sRGB, 0…1

/// How a region is shown, in pictures and in the interactive view alike.
struct RegionView {
  int region = 0;
  std::string name;    ///< as in the mesh, "pubic_arch"
  std::string label;   ///< for people, "Pubic arch"
  Colour colour{};     ///< from the palette of Okabe & Ito, which colour-blind readers can tell apart
  double opacity = 1;  ///< in the 3D views
  bool target = false;
  bool background = false;                      ///< the tissue around everything else: drawn faintly, outer faces only
  std::vector<std::array<Index, 3>> triangles;  ///< node numbers of its surface, normals outward
};

/// One view per region that has tetrahedra, in the order of the mesh's regions. A region that lies inside another keeps
/// the surface between them for itself, so that no face is drawn twice.
/// @param targets indices of the target regions
std::vector<RegionView> region_views(const TetMesh& mesh, std::span<const int> targets);

/// "Pubic arch" for "pubic_arch": a region's or event's name as a reader would write it.
std::string readable_name(const std::string& name);

}  // namespace stylet::results
