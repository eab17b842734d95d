// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/mean_displacement.hpp"

#include "bodies.hpp"
#include "stylet/geom/locator.hpp"

namespace stylet {
namespace {

using Accuracy = MeanDisplacement::Accuracy;
using test::build;
using test::ElementTest;
using test::nodes_where;

constexpr double kHeight_mm = 40.0;
constexpr double kLower_mm = 10.0;  // the volume asked about lies between
constexpr double kUpper_mm = 20.0;

/// A bar along z, held below, whose second region is a slice of it.
TetMesh sliced_bar(std::array<int, 3> cells) {
  TetMesh mesh = box_mesh({0, 0, 0}, {20, 20, kHeight_mm}, cells);
  assign_regions(mesh, {"body", "slice"}, [](const Vec3& x) { return x.z() > kLower_mm && x.z() < kUpper_mm ? 1 : 0; });
  return mesh;
}

Tissue bar(const TetMesh& mesh, double young_MPa, double poisson, Element element) {
  return build(mesh, {{young_MPa, poisson}, {young_MPa, poisson}},
               nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }), element);
}

constexpr std::array<int, 1> kSlice{1};

class MeanDisplacementOf : public ElementTest {};

TEST_P(MeanDisplacementOf, is_that_of_the_displacement_the_force_causes) {
  const TetMesh mesh = sliced_bar({3, 3, 8});
  const Tissue tissue = bar(mesh, 0.01, 0.45, GetParam());
  const auto mean = MeanDisplacement::solve(tissue, kSlice, Accuracy::of_the_tissue);
  ASSERT_TRUE(mean) << mean.error().message();
  const MaterialPoint at{7, Vec4(0.1, 0.2, 0.3, 0.4)};
  const Vec3 force(0.3, -0.2, 0.5);

  VecX load = VecX::Zero(3 * tissue.displacement_nodes());
  const Shape shape = tissue.shape(at.tet, at.weights);
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
    load.segment<3>(3 * Eigen::Index{shape.node[i]}) += shape.weight[i] * force;
  const VecX u = tissue.solve(load);
  Vec3 sum = Vec3::Zero();
  double volume = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (mesh.tet_region[static_cast<std::size_t>(t)] != 1) continue;
    // ∫ N over the volume: 1/4 at the corners of a linear element; −1/20 and 1/5 at those and the edges of a quadratic
    // one.
    const auto nodes = tissue.nodes_of(t);
    Vec3 of_tet = Vec3::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      of_tet += (nodes.size() == 4 ? 0.25 : k < 4 ? -0.05 : 0.2) * u.segment<3>(3 * Eigen::Index{nodes[k]});
    sum += tet_volume(mesh, t) * of_tet;
    volume += tet_volume(mesh, t);
  }
  EXPECT_LT((mean->per_force(at) * force - sum / volume).norm(), 1e-10 * (sum / volume).norm());
}

STYLET_FOR_EVERY_ELEMENT(MeanDisplacementOf);

// Without Poisson's effect a force F on a whole cross-section at height z moves a point at height x by F min(x,
// z)/(EA): the mean over the slice has a closed form, quadratic in z inside it, which quadratic elements represent.
TEST(MeanDisplacement, of_a_bar_is_its_theory_with_quadratic_elements_whatever_the_step_uses) {
  constexpr double young = 0.01;
  const TetMesh mesh = sliced_bar({2, 2, 8});
  const Tissue tissue = bar(mesh, young, 0.0, Element::p1);
  const Topology topology(mesh);
  const Locator locator(mesh, topology);
  for (const Accuracy accuracy : {Accuracy::quadratic, Accuracy::quadratic_halved}) {
    const auto mean = MeanDisplacement::solve(tissue, kSlice, accuracy);
    ASSERT_TRUE(mean) << mean.error().message();
    for (const double z : {3.0, 9.0, 12.0, 16.5, 20.0, 33.0}) {
      const auto at = locator.find(Vec3(6.0, 7.0, z));
      ASSERT_TRUE(at);
      const double lower = std::min(z, kLower_mm);
      const double upper = std::min(z, kUpper_mm);
      const double within = 0.5 * (upper * upper - lower * lower) + (kUpper_mm - upper) * z - (kLower_mm - lower) * z;
      const double expected = within / (kUpper_mm - kLower_mm) / (young * 20.0 * 20.0);
      EXPECT_NEAR(mean->per_force(*at)(2, 2), expected, 1e-9 * expected) << "at height " << z;
    }
  }
}

// What is left of the discretisation's error falls, whichever way the elements are made better.
TEST(MeanDisplacement, comes_nearer_to_that_of_a_fine_mesh_with_quadratic_elements_and_with_halved_edges) {
  const auto along_z = [](std::array<int, 3> cells, Accuracy accuracy) {
    const TetMesh mesh = sliced_bar(cells);
    const Tissue tissue = bar(mesh, 0.01, 0.49, Element::p1);
    const auto mean = MeanDisplacement::solve(tissue, kSlice, accuracy);
    const Topology topology(mesh);
    const Locator locator(mesh, topology);
    return mean.value().per_force(*locator.find(Vec3(9.0, 11.0, 31.0)))(2, 2);
  };
  const double fine = along_z({6, 6, 12}, Accuracy::quadratic);
  const double own = std::abs(along_z({2, 2, 4}, Accuracy::of_the_tissue) - fine);
  const double quadratic = std::abs(along_z({2, 2, 4}, Accuracy::quadratic) - fine);
  const double halved = std::abs(along_z({2, 2, 4}, Accuracy::quadratic_halved) - fine);
  EXPECT_LT(quadratic, 0.5 * own);
  EXPECT_LT(halved, 0.5 * quadratic);
}

// The iteration on quadratic elements against their factor.
TEST(MeanDisplacement, on_quadratic_elements_is_that_of_their_factor) {
  const TetMesh mesh = sliced_bar({3, 3, 6});
  for (const double poisson : {0.0, 0.45, 0.49, 0.4999}) {
    const Tissue linear = bar(mesh, 0.01, poisson, Element::p1);
    const Tissue quadratic = bar(mesh, 0.01, poisson, Element::p2);
    const auto iterated = MeanDisplacement::solve(linear, kSlice, Accuracy::quadratic);
    const auto factorised = MeanDisplacement::solve(quadratic, kSlice, Accuracy::of_the_tissue);
    ASSERT_TRUE(iterated) << iterated.error().message();
    ASSERT_TRUE(factorised) << factorised.error().message();
    for (Index tet = 0; tet < mesh.tet_count(); tet += 7) {
      const MaterialPoint at{tet, Vec4(0.1, 0.2, 0.3, 0.4)};
      const Mat3 expected = factorised->per_force(at);
      EXPECT_LT((iterated->per_force(at) - expected).norm(), 1e-7 * expected.norm()) << poisson << ", element " << tet;
    }
  }
}

TEST(MeanDisplacement, of_nothing_is_nothing) {
  const TetMesh mesh = sliced_bar({2, 2, 4});
  const Tissue tissue = bar(mesh, 0.01, 0.3, Element::p1);
  const auto mean = MeanDisplacement::solve(tissue, {}, Accuracy::of_the_tissue);
  ASSERT_TRUE(mean) << mean.error().message();
  EXPECT_TRUE(mean->per_force({0, Vec4::Constant(0.25)}).isZero(0.0));
  const auto finer = MeanDisplacement::solve(tissue, {}, Accuracy::quadratic);
  ASSERT_TRUE(finer) << finer.error().message();
  EXPECT_TRUE(finer->per_force({0, Vec4::Constant(0.25)}).isZero(0.0));
}

}  // namespace
}  // namespace stylet
