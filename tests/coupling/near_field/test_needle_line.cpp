// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/near_field/medium_block.hpp"
#include "evidence/validate/bonded_cylinder.hpp"
#include "support/sanitized.hpp"

#include <Eigen/Eigenvalues>

#include <tuple>
#include <utility>

namespace stylet {
namespace {

using test::MediumBlock;
using test::NeedleLine;

class NeedleInUnboundedMedium : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(NeedleInUnboundedMedium, needs_the_force_of_a_bonded_rigid_cylinder) {
  MediumBlock block({.cells = std::get<0>(GetParam()), .poisson = std::get<1>(GetParam())});
  const NeedleLine line(block, 4.0, {0, 0, 1}, true);
  const auto slender = validate::slender_cylinder(NeedleLine::kLength_mm, 0.635, NeedleLine::kWay_mm, block.medium);
  EXPECT_NEAR(line.lateral() / slender.lateral_N, 1.0, 0.03);
  EXPECT_NEAR(line.axial() / slender.axial_N, 1.0, 0.03);
  const auto thick = validate::bonded_cylinder(NeedleLine::kLength_mm, 0.635, NeedleLine::kWay_mm, block.medium);
  EXPECT_NEAR(line.lateral() / thick.lateral_N, 1.0, 0.03);
  EXPECT_NEAR(line.axial() / thick.axial_N, 1.0, 0.03);
}
// At ν = 0.49 linear tetrahedra lock in the far field; the element without locking has its own tests.
INSTANTIATE_TEST_SUITE_P(MeshesAndMedia, NeedleInUnboundedMedium,
                         testing::Combine(testing::ValuesIn(test::meshes({7, 10, 14})), testing::Values(0.3, 0.45)));

/// Smallest and largest of a number of forces.
struct Range {
  double least = 1e9;
  double most = 0.0;
  void add(double force) {
    least = std::min(least, force);
    most = std::max(most, force);
  }
};

/// An element, and the allowed spread of the forces with it.
using Allowed = std::pair<Element, double>;
class NeedleInABox : public testing::TestWithParam<Allowed> {};

TEST_P(NeedleInABox, needs_the_same_force_on_any_mesh_at_any_spacing_in_any_direction) {
  const auto [element, allowed] = GetParam();
  Range lateral;
  Range axial;
  for (const int cells : {7, 10, 16}) {
    MediumBlock block({.cells = cells, .element = element});
    for (const double spacing : {8.0, 4.0, 2.0}) {
      for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0.4, 0.1, 0.9)}) {
        const NeedleLine line(block, spacing, direction, false);
        lateral.add(line.lateral());
        axial.add(line.axial());
      }
    }
  }
  EXPECT_LT(lateral.most / lateral.least, 1.0 + allowed);
  EXPECT_LT(axial.most / axial.least, 1.0 + allowed);
  // Boundary elements that include the box's walls give 3.62 N and 2.29 N.
  EXPECT_NEAR(0.5 * (lateral.least + lateral.most), 3.62, 0.03 * 3.62);
  EXPECT_NEAR(0.5 * (axial.least + axial.most), 2.29, 0.05 * 2.29);
}
INSTANTIATE_TEST_SUITE_P(Elements, NeedleInABox,
                         testing::Values(Allowed(Element::nodal_pressure, 0.03), Allowed(Element::p1, 0.06)));

TEST(NeedleHeldClosely, contacts_as_close_as_the_diameter_are_independent_of_each_other) {
  MediumBlock block({.cells = 7});
  const NeedleLine line(block, 1.28, {0, 0, 1}, false);
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(line.A, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues()[0], 0.0);
  EXPECT_LT(eigen.eigenvalues()[eigen.eigenvalues().size() - 1] / eigen.eigenvalues()[0], 300.0);
}

}  // namespace
}  // namespace stylet
