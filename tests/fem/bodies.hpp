// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
inline Tissue build(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                    Element element = Element::p1) {
  auto tissue = Tissue::build(std::move(mesh), std::move(materials), std::move(fixed), {}, element);
  if (!tissue) throw std::runtime_error(tissue.error().message());
  return std::move(*tissue);
}

/// Nodal values of a displacement field [mm] (3 × displacement nodes).
inline VecX sample(const Tissue& tissue, const std::function<Vec3(const Vec3&)>& field) {
  VecX u(3 * Eigen::Index{tissue.displacement_nodes()});
  for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
    u.segment<3>(3 * Eigen::Index{a}) = field(tissue.node_position(a));
  }
  return u;
}

/// Nodal forces [N] (3 × displacement nodes) of the traction σ n on the outer faces, constant on a face: a third on
/// each corner of a linear face, on each edge's middle of a quadratic one.
/// @param stress_at σ at the middle of a face [mm] of a region
inline VecX traction(const Tissue& tissue, const std::function<Mat3(const Vec3&, int region)>& stress_at) {
  const TetMesh& mesh = tissue.mesh();
  VecX f = VecX::Zero(3 * Eigen::Index{tissue.displacement_nodes()});
  const Topology topology(mesh);
  for (const Face& face : topology.boundary) {
    const Vec3& origin = mesh.nodes[face.nodes[0]];
    const Vec3 area = 0.5 * (mesh.nodes[face.nodes[1]] - origin).cross(mesh.nodes[face.nodes[2]] - origin);
    const Vec3 middle = (origin + mesh.nodes[face.nodes[1]] + mesh.nodes[face.nodes[2]]) / 3.0;
    const Vec3 share = stress_at(middle, mesh.tet_region[face.tet]) * area / 3.0;
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

/// The same with σ by region.
inline VecX traction_by_region(const Tissue& tissue, const std::vector<Mat3>& stress_of_region) {
  return traction(tissue, [&](const Vec3&, int region) { return stress_of_region[region]; });
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
inline Vec3 moment(const Tissue& tissue, const VecX& f) {
  Vec3 total = Vec3::Zero();
  for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
    total += tissue.node_position(a).cross(f.segment<3>(3 * Eigen::Index{a}));
  }
  return total;
}

inline Vec3 resultant(const VecX& f) {
  return Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>(f.data(), 3, f.size() / 3).rowwise().sum();
}

/// A claim that is tested with every kind of element.
using ElementTest = testing::TestWithParam<Element>;
inline std::string test_name(const testing::TestParamInfo<Element>& element) {
  std::string name = to_string(element.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
#define STYLET_FOR_EVERY_ELEMENT(suite)                                                                       \
  INSTANTIATE_TEST_SUITE_P(Tissue, suite, testing::Values(Element::p1, Element::nodal_pressure, Element::p2), \
                           test::test_name)

}  // namespace stylet::test
