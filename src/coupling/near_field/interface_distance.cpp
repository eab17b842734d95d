// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/interface_distance.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

InterfaceDistance::InterfaceDistance(const Tissue& tissue, const Topology& topology) {
  const TetMesh& mesh = tissue.mesh();
  const std::size_t regions = mesh.regions.size();
  const auto region_of = [&](Index tet) {
    return static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(tet)]);
  };
  std::vector<char> gives_way(regions, 0);
  for (Index tet = 0; tet < mesh.tet_count(); ++tet) {
    for (const Index node : mesh.tets[static_cast<std::size_t>(tet)]) {
      if (!tissue.is_fixed(node)) gives_way[region_of(tet)] = 1;
    }
  }
  std::vector<std::vector<std::array<Index, 3>>> faces(regions);
  std::vector<std::vector<double>> modulus(regions);
  beyond_.resize(regions);
  for (const Face& face : topology.interfaces) {
    const std::size_t a = region_of(face.tet);
    const std::size_t b = region_of(face.neighbour);
    if (gives_way[a] == 0 || gives_way[b] == 0) continue;
    const double young_a = tissue.materials()[a].young_MPa;
    const double young_b = tissue.materials()[b].young_MPa;
    if (young_a == young_b) continue;
    faces[a].push_back(face.nodes);
    modulus[a].push_back(std::log(young_b));
    beyond_[a].push_back(static_cast<int>(b));
    faces[b].push_back({face.nodes[0], face.nodes[2], face.nodes[1]});
    modulus[b].push_back(std::log(young_a));
    beyond_[b].push_back(static_cast<int>(a));
  }
  of_region_.reserve(regions);
  for (std::size_t r = 0; r < regions; ++r) of_region_.emplace_back(mesh.nodes, std::move(faces[r]), modulus[r]);
}

NearInterfaces InterfaceDistance::nearest(int region, const Vec3& x) const {
  const auto r = static_cast<std::size_t>(region);
  const SurfaceDistance& interfaces = of_region_[r];
  SurfaceDistance::Value log_modulus;
  const auto told = [&](const NearSurface& found) -> NearInterface {
    if (!std::isfinite(found.depth)) return {};
    return {found.depth, found.inwards, log_modulus.value, beyond_[r][static_cast<std::size_t>(log_modulus.triangle)]};
  };
  const NearInterface first = told(interfaces.nearest(x, &log_modulus));
  if (first.beyond < 0) return {};
  return {first, told(interfaces.opposite(x, first.inwards, &log_modulus))};
}

}  // namespace stylet
