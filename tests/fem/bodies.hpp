// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "evidence/validate/solids.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace stylet::test {

using validate::nodes_where;
using validate::relative_error;
using validate::sample;
using validate::stress_of;
using validate::traction;

/// Builds a tissue, or fails the test with the error's message.
inline Tissue build(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                    Element element = Element::p1) {
  auto tissue = Tissue::build(std::move(mesh), std::move(materials), std::move(fixed), {}, element);
  if (!tissue) throw std::runtime_error(tissue.error().message());
  return std::move(*tissue);
}

/// validate::traction() with one stress σ per region.
inline VecX traction_by_region(const Tissue& tissue, const std::vector<Mat3>& stress_of_region) {
  return traction(tissue, [&](const Vec3&, int region) { return stress_of_region[region]; });
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
