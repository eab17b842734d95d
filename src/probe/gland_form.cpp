// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/gland_form.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <set>

namespace stylet {

GlandMeasure::GlandMeasure(const TetMesh& mesh, const Topology& topology, std::span<const int> regions) : mesh_(&mesh) {
  const auto is_gland = [&](Index tet) {
    return tet >= 0 &&
           std::find(regions.begin(), regions.end(), mesh.tet_region[static_cast<std::size_t>(tet)]) != regions.end();
  };
  std::set<Index> nodes;
  for (const auto* faces : {&topology.interfaces, &topology.boundary}) {
    for (const Face& face : *faces) {
      if (is_gland(face.tet) != is_gland(face.neighbour)) nodes.insert(face.nodes.begin(), face.nodes.end());
    }
  }
  surface_.assign(nodes.begin(), nodes.end());
  for (Index t = 0; t < mesh.tet_count(); ++t)
    if (is_gland(t)) tets_.push_back(t);
}

GlandForm GlandMeasure::form(const Eigen::Ref<const Eigen::Matrix3Xf>& u) const {
  GlandForm form;
  Eigen::AlignedBox3d before;
  Eigen::AlignedBox3d after;
  for (const Index node : surface_) {
    const Vec3& x = mesh_->nodes[static_cast<std::size_t>(node)];
    before.extend(x);
    after.extend(Vec3(x + u.col(node).cast<double>()));
  }
  form.extent_mm = before.sizes();
  form.change_percent = 100.0 * (after.sizes().cwiseQuotient(before.sizes()) - Vec3::Ones());
  double volume = 0.0;
  double growth = 0.0;
  for (const Index t : tets_) {
    const double v = tet_volume(*mesh_, t);
    const auto gradients = barycentric_gradients(*mesh_, t);
    volume += v;
    for (int a = 0; a < 4; ++a) {
      const Vec3 moved = u.col(mesh_->tets[static_cast<std::size_t>(t)][static_cast<std::size_t>(a)]).cast<double>();
      growth += v * gradients.col(a).dot(moved);
      form.shift_mm += 0.25 * v * moved;
    }
  }
  form.shift_mm /= volume;
  form.volume_percent = 100.0 * growth / volume;
  return form;
}

}  // namespace stylet
