// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids.hpp"

#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::validate {

std::vector<Index> nodes_where(const TetMesh& mesh, const std::function<bool(const Vec3&)>& chosen) {
  std::vector<Index> nodes;
  for (Index a = 0; a < mesh.node_count(); ++a)
    if (chosen(mesh.nodes[static_cast<std::size_t>(a)])) nodes.push_back(a);
  return nodes;
}

VecX sample(const Tissue& tissue, const std::function<Vec3(const Vec3&)>& field) {
  VecX u(3 * Eigen::Index{tissue.displacement_nodes()});
  for (Index a = 0; a < tissue.displacement_nodes(); ++a)
    u.segment<3>(3 * Eigen::Index{a}) = field(tissue.node_position(a));
  return u;
}

Mat3 stress_of(const Material& material, const Mat3& gradient) {
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  return material.lambda() * strain.trace() * Mat3::Identity() + 2.0 * material.mu() * strain;
}

VecX traction(const Tissue& tissue, const std::function<Mat3(const Vec3&, int region)>& stress_at) {
  const TetMesh& mesh = tissue.mesh();
  VecX f = VecX::Zero(3 * Eigen::Index{tissue.displacement_nodes()});
  const Topology topology(mesh);
  for (const Face& face : topology.boundary) {
    const auto x = [&](std::size_t k) -> const Vec3& { return mesh.nodes[static_cast<std::size_t>(face.nodes[k])]; };
    const Vec3 area = 0.5 * (x(1) - x(0)).cross(x(2) - x(0));
    const Vec3 middle = (x(0) + x(1) + x(2)) / 3.0;
    const Vec3 share = stress_at(middle, mesh.tet_region[static_cast<std::size_t>(face.tet)]) * area / 3.0;
    for (const Index a : tissue.nodes_of(face.tet)) {
      const auto ends = tissue.ends_of(a);
      const auto on_face = [&](Index end) {
        return std::find(face.nodes.begin(), face.nodes.end(), end) != face.nodes.end();
      };
      const bool carries = tissue.element() == Element::p2 ? ends[0] != ends[1] : ends[0] == ends[1];
      if (carries && on_face(ends[0]) && on_face(ends[1])) f.segment<3>(3 * Eigen::Index{a}) += share;
    }
  }
  return f;
}

double relative_error(const VecX& value, const VecX& expected) {
  return (value - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

Result<PressedBlock> press_block(const Material& material, int cells, Element element) {
  constexpr double side_mm = 60.0;
  constexpr double peak_MPa = 2e-3;
  TetMesh mesh = box_mesh({0, 0, 0}, Vec3::Constant(side_mm), {cells, cells, cells}, 0.1);
  const auto floor = nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
  const auto tissue = Tissue::build(std::move(mesh), {material}, floor, {}, element);
  if (!tissue) return tissue.error();
  const VecX f = traction(*tissue, [&](const Vec3& x, int /*region*/) {
    Mat3 stress = Mat3::Zero();
    const double hill = std::sin(std::numbers::pi * x.x() / side_mm) * std::sin(std::numbers::pi * x.y() / side_mm);
    if (x.z() == side_mm) stress(2, 2) = -peak_MPa * hill * hill;
    return stress;
  });
  double total = 0.0;
  for (Eigen::Index k = 2; k < f.size(); k += 3) total += f[k];
  return PressedBlock{f.dot(VecX(tissue->solve(f))) / std::abs(total), tissue->displacement_nodes()};
}

}  // namespace stylet::validate
