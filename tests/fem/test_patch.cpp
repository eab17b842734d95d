// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"

#include "stylet/fem/patch.hpp"

#include <Eigen/Eigenvalues>

namespace stylet {
namespace {

const Material kSoftTissue{0.04, 0.45};

Tissue body(const Material& material, Element element) {
  TetMesh mesh = box_mesh({-20, 10, 30}, {20, 50, 90}, {3, 3, 3}, 0.15);
  const auto fixed = test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 30.0; });
  return test::build(std::move(mesh), {material}, fixed, element);
}

using PatchStiffnesses = test::ElementTest;
STYLET_FOR_EVERY_ELEMENT(PatchStiffnesses);

TEST_P(PatchStiffnesses, OfAllElementsIsTheTissuesStiffness) {
  const Tissue tissue = body(kSoftTissue, GetParam());
  std::vector<Index> all;
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) all.push_back(t);
  const PatchStiffness patch = patch_stiffness(tissue, all, kSoftTissue);
  ASSERT_EQ(patch.nodes.size(), static_cast<std::size_t>(tissue.displacement_nodes()));
  const MatX K = tissue.stiffness();
  for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
    for (Index b = 0; b < tissue.displacement_nodes(); ++b) {
      if (tissue.is_fixed(a) || tissue.is_fixed(b)) continue;
      const Mat3 block = K.block<3, 3>(tissue.first_dof(a), tissue.first_dof(b));
      EXPECT_LT((patch.K.block<3, 3>(3 * a, 3 * b) - block).norm(), 1e-12 * K.diagonal().maxCoeff());
    }
  }
}

TEST_P(PatchStiffnesses, HasNoKernelButTheSixRigidMotionsAndTakesItsOwnMaterial) {
  const Tissue tissue = body({1.0, 0.1}, GetParam());
  const std::vector<Index> tets{42, 36, 37, 38, 39, 40, 41, 43, 44, 45, 46, 47};  // two neighbouring cells
  const PatchStiffness patch = patch_stiffness(tissue, tets, kSoftTissue);
  EXPECT_EQ((patch.K - patch.K.transpose()).norm(), 0.0);
  EXPECT_TRUE(std::is_sorted(patch.nodes.begin(), patch.nodes.end()));
  const auto p = static_cast<Eigen::Index>(patch.nodes.size());
  for (int mode = 0; mode < 6; ++mode) {
    VecX u(3 * p);
    for (Eigen::Index i = 0; i < p; ++i) {
      const Vec3 x = tissue.node_position(patch.nodes[static_cast<std::size_t>(i)]) / 60.0;
      u.segment<3>(3 * i) = mode < 3 ? Vec3::Unit(mode) : Vec3(Vec3::Unit(mode - 3).cross(x));
    }
    EXPECT_LT((patch.K * u).norm(), 1e-12 * patch.K.norm() * u.norm());
  }
  const VecX values = Eigen::SelfAdjointEigenSolver<MatX>(patch.K, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_LT(std::abs(values[5]), 1e-12 * values[values.size() - 1]);
  EXPECT_GT(values[6], 1e-4 * values[values.size() - 1]);

  const PatchStiffness stiffer = patch_stiffness(tissue, tets, {2 * kSoftTissue.young_MPa, kSoftTissue.poisson});
  EXPECT_LT((stiffer.K - 2 * patch.K).norm(), 1e-12 * stiffer.K.norm());
}

}  // namespace
}  // namespace stylet
