// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Json extent_json(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return nullptr;
  const auto corner = [](const Vec3& p) { return Json::array({p.x(), p.y(), p.z()}); };
  return {{"min", corner(box.min())}, {"max", corner(box.max())}};
}

std::string extent_text(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return "-";
  const Vec3 size = box.sizes();
  return fmt::format("{:.1f} × {:.1f} × {:.1f}", size.x(), size.y(), size.z());
}

Json quality_json(const MeshQuality& quality) {
  return {{"nodes", quality.nodes},
          {"tets", quality.tets},
          {"dihedral_deg", {{"min", quality.dihedral_deg.min}, {"max", quality.dihedral_deg.max}}},
          {"edge_mm", {{"min", quality.edge_mm.min}, {"max", quality.edge_mm.max}}},
          {"radius_ratio_min", quality.radius_ratio_min},
          {"fraction_below_12_deg", quality.fraction_below_12_deg},
          {"dihedral_histogram_10_deg", quality.dihedral_histogram}};
}

}  // namespace stylet::cli
