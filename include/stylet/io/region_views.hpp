// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace stylet::results {

using Colour = std::array<double, 3>;  ///< sRGB, 0…1

/// A colour for pages: "#d55e00".
std::string hex(const Colour& colour);

/// Appearance of a region in pictures and in the interactive view.
struct RegionView {
  int region = 0;
  std::string name;    ///< as in the mesh, "pubic_arch"
  std::string label;   ///< as displayed, "Pubic arch"
  Colour colour{};     ///< from the palette of Okabe & Ito, which colour-blind readers can tell apart
  double opacity = 1;  ///< in the 3D views
  bool target = false;
  bool soft_layer = false;  ///< fat or muscle around organs: drawn faintly, so that the organs are seen
  bool background = false;  ///< tissue that surrounds the other regions: drawn faintly, with its outer faces only
  std::vector<std::array<Index, 3>> triangles;  ///< node numbers of its surface, normals outward
};

/// One view per region that has tetrahedra, in the order of the mesh's regions. A face between a region and a region
/// around it belongs to the inner one only, so that no face is drawn twice.
/// @param targets indices of the target regions
std::vector<RegionView> region_views(const TetMesh& mesh, std::span<const int> targets);

/// The name of a region or event for display: "Pubic arch" for "pubic_arch".
std::string readable_name(const std::string& name);

}  // namespace stylet::results
