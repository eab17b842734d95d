// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace stylet::test {

/// Nodes for which `chosen` holds.
inline std::vector<Index> nodes_where(const TetMesh& mesh, const std::function<bool(const Vec3&)>& chosen) {
  std::vector<Index> nodes;
  for (Index a = 0; a < mesh.node_count(); ++a) {
    if (chosen(mesh.nodes[a])) nodes.push_back(a);
  }
  return nodes;
}

/// Builds, or fails the test with the error's message.
inline Tissue build(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed) {
  auto tissue = Tissue::build(std::move(mesh), std::move(materials), std::move(fixed));
  if (!tissue) throw std::runtime_error(tissue.error().message());
  return std::move(*tissue);
}

/// Nodal values of a displacement field [mm] (3n).
inline VecX sample(const TetMesh& mesh, const std::function<Vec3(const Vec3&)>& field) {
  VecX u(3 * Eigen::Index{mesh.node_count()});
  for (Index a = 0; a < mesh.node_count(); ++a) u.segment<3>(3 * Eigen::Index{a}) = field(mesh.nodes[a]);
  return u;
}

/// Nodal forces [N] (3n) of the traction σ n on the outer faces, σ by region, constant on a face.
inline VecX traction(const TetMesh& mesh, const std::vector<Mat3>& stress_of_region) {
  VecX f = VecX::Zero(3 * Eigen::Index{mesh.node_count()});
  const Topology topology(mesh);
  for (const Face& face : topology.boundary) {
    const Vec3& origin = mesh.nodes[face.nodes[0]];
    const Vec3 area = 0.5 * (mesh.nodes[face.nodes[1]] - origin).cross(mesh.nodes[face.nodes[2]] - origin);
    const Vec3 share = stress_of_region[mesh.tet_region[face.tet]] * area / 3.0;
    for (const Index a : face.nodes) f.segment<3>(3 * Eigen::Index{a}) += share;
  }
  return f;
}

/// Stress of a homogeneous displacement gradient.
inline Mat3 stress_of(const Material& material, const Mat3& gradient) {
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  return material.lambda() * strain.trace() * Mat3::Identity() + 2.0 * material.mu() * strain;
}

/// Largest deviation relative to the largest value.
inline double relative_error(const VecX& value, const VecX& expected) {
  return (value - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

/// Moment of nodal forces about the origin [N mm].
inline Vec3 moment(const TetMesh& mesh, const VecX& f) {
  Vec3 total = Vec3::Zero();
  for (Index a = 0; a < mesh.node_count(); ++a) total += mesh.nodes[a].cross(f.segment<3>(3 * Eigen::Index{a}));
  return total;
}

inline Vec3 resultant(const VecX& f) {
  return Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>(f.data(), 3, f.size() / 3).rowwise().sum();
}

}  // namespace stylet::test
