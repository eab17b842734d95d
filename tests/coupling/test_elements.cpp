// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolated contacts in every kind of element, against separate solves.
#include "stylet/coupling/track_compliance.hpp"

#include "two_region_block.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using stylet::test::Block;

namespace {

class EmbeddedPoints : public testing::TestWithParam<Element> {
 protected:
  EmbeddedPoints() : block(3, GetParam()), track(block.store, *block.locator, 8) {
    const auto at = block.locator->find(places[0]);
    track.move_tip(*at, places[0]);
    for (std::size_t k = 1; k < places.size(); ++k)
      track.add(*block.locator->find(places[k]), places[k], Placement::embedded);
    forces = MatX::Zero(3, static_cast<Eigen::Index>(places.size()));
    forces.col(0) << 0.2, -0.1, 0.4;
    forces.col(2) << -0.3, 0.1, 0.2;
  }

  /// Displacement of all displacement nodes by forces on the points.
  [[nodiscard]] VecX solved() const {
    const Tissue& tissue = *block.tissue;
    VecX f = VecX::Zero(3 * tissue.displacement_nodes());
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto at = block.locator->find(places[k]);
      const Shape shape = tissue.shape(at->tet, at->weights);
      for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
        f.segment<3>(3 * shape.node[i]) += shape.weight[i] * forces.col(static_cast<Eigen::Index>(k));
    }
    return tissue.solve(f);
  }
  [[nodiscard]] Vec3 displacement_at(const VecX& u, const Vec3& x) const {
    const auto at = block.locator->find(x);
    const Shape shape = block.tissue->shape(at->tet, at->weights);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      sum += shape.weight[i] * u.segment<3>(3 * shape.node[i]);
    return sum;
  }

  const std::vector<Vec3> places{{18.0, 21.0, 12.0}, {19.0, 20.0, 3.0}, {30.0, 11.0, 20.0}, {31.0, 12.5, 20.5}};
  Block block;
  TrackCompliance track;
  MatX forces;
};

TEST_P(EmbeddedPoints, move_as_their_element_does) {
  const VecX u = solved();
  ASSERT_EQ(track.points(), static_cast<int>(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k) {
    Vec3 moved = Vec3::Zero();
    for (int d = 0; d < track.points(); ++d) moved += track(static_cast<int>(k), d) * forces.col(d);
    EXPECT_LT((moved - displacement_at(u, places[k])).norm(), 1e-11 * u.cwiseAbs().maxCoeff());
  }
}

TEST_P(EmbeddedPoints, deform_the_tissue_around_the_tip_as_the_element_says) {
  const VecX u = solved();
  Mat3 expected;
  constexpr double step = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 aside = step * Vec3::Unit(axis);
    expected.col(axis) = (displacement_at(u, places[0] + aside) - displacement_at(u, places[0] - aside)) / (2.0 * step);
  }
  EXPECT_LT((track.gradient_at_tip(forces) - expected).norm(), 1e-8 * expected.norm());
}

TEST_P(EmbeddedPoints, move_the_meshs_nodes_and_pull_on_the_supports_by_what_acts_on_them) {
  const VecX u = solved();
  const VecX of_nodes = track.displacement(forces);
  ASSERT_EQ(of_nodes.size(), 3 * block.tissue->mesh().node_count());
  EXPECT_LT((of_nodes - u.head(of_nodes.size())).norm(), 1e-12 * u.norm());
  const auto nodes = track.nodes(forces);
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  for (std::size_t a = 0; a < nodes.position.size(); ++a) {
    const Vec3 both = nodes.load.segment<3>(static_cast<Eigen::Index>(3 * a)) +
                      nodes.support.segment<3>(static_cast<Eigen::Index>(3 * a));
    force += both;
    torque += nodes.position[a].cross(both);
  }
  EXPECT_LT(force.norm(), 1e-11);
  EXPECT_LT(torque.norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Elements, EmbeddedPoints, testing::Values(Element::p1, Element::nodal_pressure, Element::p2),
                         [](const auto& element) {
                           return std::string(element.param == Element::nodal_pressure ? "nodal_pressure"
                                                                                       : to_string(element.param));
                         });

}  // namespace
