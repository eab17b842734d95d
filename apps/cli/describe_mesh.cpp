// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"
#include "table.hpp"

#include "stylet/geom/flat_tets.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Description describe(const TetMesh& mesh) {
  const MeshQuality quality = mesh_quality(mesh);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.nodes) box.extend(p);

  Description out;
  out.json = {{"kind", "mesh"}};
  out.json.update(quality_json(quality));
  out.json["extent_mm"] = extent_json(box);
  out.json["regions"] = Json::object();
  Table table({"region", "tetrahedra", "volume cc"});
  for (std::size_t region = 0; region < mesh.regions.size(); ++region) {
    const std::string& name = mesh.regions[region];
    out.json["regions"][name] = {{"tets", quality.region_tets[region]},
                                 {"volume_cc", quality.region_volume_cc[region]}};
    table.row(
        {name, fmt::to_string(quality.region_tets[region]), fmt::format("{:.2f}", quality.region_volume_cc[region])});
  }

  Facts facts;
  facts.add("kind", "tetrahedral mesh");
  facts.add("nodes", fmt::to_string(quality.nodes));
  facts.add("tetrahedra", fmt::to_string(quality.tets));
  facts.add("extent", extent_text(box) + " mm");
  facts.add("edges", fmt::format("{:.2f} … {:.2f} mm", quality.edge_mm.min, quality.edge_mm.max));
  facts.add("dihedral angles", fmt::format("{:.1f}° … {:.1f}°", quality.dihedral_deg.min, quality.dihedral_deg.max));
  facts.add("radius ratio", fmt::format("≥ {:.3f} (1 for a regular tetrahedron)", quality.radius_ratio_min));
  out.text = facts.text() + "\n\n" + table.text();
  if (const std::string flat = nearly_flat_warning(mesh); !flat.empty()) out.warnings.push_back(flat);
  out.json["warnings"] = out.warnings;
  return out;
}

}  // namespace stylet::cli
