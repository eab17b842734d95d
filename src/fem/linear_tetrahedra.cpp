// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear_tetrahedra.hpp"

#include "stress.hpp"
#include "stylet/fem/tissue.hpp"

#include <algorithm>

namespace stylet {

Mat3 element_block(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material, int a,
                   int b) {
  return detail::stiffness_block(gradients.col(a), gradients.col(b), volume * material.lambda(),
                                 volume * material.mu());
}

namespace detail {

Shape LinearTetrahedra::shape(Index tet, const Vec4& weights) const {
  Shape shape;
  shape.count = 4;
  for (int i = 0; i < 4; ++i) {
    shape.node[i] = mesh_.tets[tet][i];
    shape.weight[i] = weights[i];
  }
  return shape;
}

ShapeGradients LinearTetrahedra::shape_gradients(Index tet, const Vec4& /*weights*/) const {
  ShapeGradients shape;
  shape.count = 4;
  shape.gradient.leftCols<4>() = barycentric_gradients(mesh_, tet);
  for (int i = 0; i < 4; ++i) shape.node[i] = mesh_.tets[tet][i];
  return shape;
}

void LinearTetrahedra::stiffness(std::span<const Index> tets, const MaterialOf& material, const Add& add) const {
  MatX K(12, 12);
  for (const Index t : tets) {
    const auto gradients = barycentric_gradients(mesh_, t);
    const double volume = tet_volume(mesh_, t);
    const Material of_tet = material(t);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b <= a; ++b) K.block<3, 3>(3 * a, 3 * b) = element_block(gradients, volume, of_tet, a, b);
    }
    add(mesh_.tets[t], K);
  }
}

void LinearTetrahedra::parts(std::span<const Index> tets, const MaterialOf& /*material*/, const Visit& visit) const {
  for (const Index t : tets) visit(mesh_.tets[t]);
}

Mat3 LinearTetrahedra::gradient(Index tet, const VecX& u) const {
  Eigen::Matrix<double, 3, 4> values;
  for (int a = 0; a < 4; ++a) values.col(a) = u.segment<3>(3 * Eigen::Index{mesh_.tets[tet][a]});
  return values * barycentric_gradients(mesh_, tet).transpose();
}

MatX LinearTetrahedra::stress(const MaterialOf& material, const VecX& u) const {
  MatX stresses(6, mesh_.tet_count());
  for (Index t = 0; t < mesh_.tet_count(); ++t) {
    stresses.col(t) = six_components(cauchy_stress(material(t), gradient(t, u)));
  }
  return stresses;
}

VecX LinearTetrahedra::forces(const MaterialOf& material, const VecX& u, const std::vector<char>& wanted) const {
  // The nodal forces of a linear tetrahedron are V σ g_a.
  const MatX stresses = stress(material, u);
  VecX forces = VecX::Zero(u.size());
  for (Index t = 0; t < mesh_.tet_count(); ++t) {
    const auto& tet = mesh_.tets[t];
    if (std::none_of(tet.begin(), tet.end(), [&](Index a) { return wanted[a]; })) continue;
    const auto s = stresses.col(t);
    Mat3 sigma;
    sigma << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const Eigen::Matrix<double, 3, 4> pulls = tet_volume(mesh_, t) * sigma * barycentric_gradients(mesh_, t);
    for (int a = 0; a < 4; ++a) {
      if (wanted[tet[a]]) forces.segment<3>(3 * Eigen::Index{tet[a]}) += pulls.col(a);
    }
  }
  return forces;
}

}  // namespace detail

}  // namespace stylet
