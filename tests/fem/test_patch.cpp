// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"

#include "stylet/fem/patch.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <set>

namespace stylet {
namespace {

const Material kSoftTissue{0.04, 0.45};

Tissue body(const Material& material, Element element) {
  TetMesh mesh = box_mesh({-20, 10, 30}, {20, 50, 90}, {3, 3, 3}, 0.15);
  const auto fixed = test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 30.0; });
  return test::build(std::move(mesh), {material}, fixed, element);
}

std::vector<Index> nodes_of(const Tissue& tissue, const std::vector<Index>& tets) {
  std::set<Index> nodes;
  for (const Index t : tets) nodes.insert(tissue.nodes_of(t).begin(), tissue.nodes_of(t).end());
  return {nodes.begin(), nodes.end()};
}

/// A patch with its whole matrix.
struct Whole {
  Patch patch;
  MatX K;  ///< [N/mm] (3m × 3p) with both triangles

  Whole(const Tissue& tissue, const std::vector<Index>& tets, const std::vector<Index>& nodes,
        const std::vector<char>& moves, const Material& material) {
    patch.assemble(tissue, tets, nodes, moves, material);
    K = patch.K();
    const Eigen::Index inside = K.rows();
    const MatX lower = K.leftCols(inside);
    K.leftCols(inside) = lower.selfadjointView<Eigen::Lower>();
  }
};

/// A patch without held nodes.
Whole loose(const Tissue& tissue, const std::vector<Index>& tets, const Material& material) {
  const std::vector<Index> nodes = nodes_of(tissue, tets);
  return {tissue, tets, nodes, std::vector<char>(nodes.size(), 1), material};
}

using Patches = test::ElementTest;
STYLET_FOR_EVERY_ELEMENT(Patches);

TEST_P(Patches, of_all_elements_have_the_tissues_stiffness) {
  const Tissue tissue = body(kSoftTissue, GetParam());
  std::vector<Index> all;
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) all.push_back(t);
  const Whole patch = loose(tissue, all, kSoftTissue);
  ASSERT_EQ(patch.patch.nodes().size(), static_cast<std::size_t>(tissue.displacement_nodes()));
  const MatX K = tissue.stiffness();
  for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
    for (Index b = 0; b < tissue.displacement_nodes(); ++b) {
      if (tissue.is_fixed(a) || tissue.is_fixed(b)) continue;
      const Mat3 block = K.block<3, 3>(tissue.first_dof(a), tissue.first_dof(b));
      EXPECT_LT((patch.K.block<3, 3>(3 * a, 3 * b) - block).norm(), 1e-12 * K.diagonal().maxCoeff());
    }
  }
}

TEST_P(Patches, have_no_kernel_but_the_six_rigid_motions_and_their_own_material) {
  const Tissue tissue = body({1.0, 0.1}, GetParam());
  const std::vector<Index> tets{42, 36, 37, 38, 39, 40, 41, 43, 44, 45, 46, 47};  // two neighbouring cells
  const Whole patch = loose(tissue, tets, kSoftTissue);
  EXPECT_TRUE(std::is_sorted(patch.patch.nodes().begin(), patch.patch.nodes().end()));
  const auto p = static_cast<Eigen::Index>(patch.patch.nodes().size());
  for (int mode = 0; mode < 6; ++mode) {
    VecX u(3 * p);
    for (Eigen::Index i = 0; i < p; ++i) {
      const Vec3 x = tissue.node_position(patch.patch.nodes()[static_cast<std::size_t>(i)]) / 60.0;
      u.segment<3>(3 * i) = mode < 3 ? Vec3::Unit(mode) : Vec3(Vec3::Unit(mode - 3).cross(x));
    }
    EXPECT_LT((patch.K * u).norm(), 1e-12 * patch.K.norm() * u.norm());
  }
  const VecX values = Eigen::SelfAdjointEigenSolver<MatX>(patch.K, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_LT(std::abs(values[5]), 1e-12 * values[values.size() - 1]);
  EXPECT_GT(values[6], 1e-4 * values[values.size() - 1]);

  const Whole stiffer = loose(tissue, tets, {2 * kSoftTissue.young_MPa, kSoftTissue.poisson});
  EXPECT_LT((stiffer.K - 2 * patch.K).norm(), 1e-12 * stiffer.K.norm());
}

TEST_P(Patches, have_the_rows_of_the_nodes_that_move_with_the_others_behind) {
  const Tissue tissue = body(kSoftTissue, GetParam());
  const std::vector<Index> tets{42, 36, 37, 38, 39, 40, 41, 43, 44, 45, 46, 47};
  const std::vector<Index> nodes = nodes_of(tissue, tets);
  std::vector<char> moves(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) moves[k] = k % 3 != 1 ? 1 : 0;
  const Whole whole = loose(tissue, tets, kSoftTissue);
  const Whole patch(tissue, tets, nodes, moves, kSoftTissue);
  ASSERT_EQ(patch.patch.nodes().size(), nodes.size());
  ASSERT_EQ(patch.patch.moving(), std::count(moves.begin(), moves.end(), 1));
  ASSERT_EQ(patch.K.rows(), 3 * patch.patch.moving());
  const auto place = [&](Index node) {
    return 3 * (std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  for (Index a = 0; a < patch.patch.moving(); ++a) {
    EXPECT_EQ(moves[static_cast<std::size_t>(place(patch.patch.nodes()[static_cast<std::size_t>(a)]) / 3)], 1);
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      const Mat3 expected =
          whole.K.block<3, 3>(place(patch.patch.nodes()[static_cast<std::size_t>(a)]), place(patch.patch.nodes()[b]));
      const Mat3 block = patch.K.block<3, 3>(3 * a, 3 * static_cast<Eigen::Index>(b));
      EXPECT_LT((block - expected).norm(), 1e-14 * whole.K.norm()) << a << ' ' << b;
    }
  }
}

TEST_P(Patches, carry_a_linear_field_on_from_the_nodes_whose_displacement_is_given_and_balance_forces) {
  const Tissue tissue = body(kSoftTissue, GetParam());
  std::vector<Index> all;
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) all.push_back(t);
  const std::vector<Index> nodes = nodes_of(tissue, all);
  std::vector<char> moves(nodes.size());
  const Vec3 lo(-20, 10, 30);
  const Vec3 hi(20, 50, 90);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Vec3 x = tissue.node_position(nodes[k]);
    moves[k] = (x - lo).minCoeff() > 1e-9 && (hi - x).minCoeff() > 1e-9 ? 1 : 0;
  }
  Whole patch(tissue, all, nodes, moves, kSoftTissue);
  ASSERT_GT(patch.patch.moving(), 0);
  Mat3 gradient;
  gradient << 0.02, -0.01, 0.03, 0.01, -0.03, 0.0, 0.02, 0.04, 0.01;
  VecX field(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k)
    field.segment<3>(3 * static_cast<Eigen::Index>(k)) = gradient * tissue.node_position(patch.patch.nodes()[k]);
  const Eigen::Index inside = 3 * Eigen::Index{patch.patch.moving()};
  const VecX given = field.tail(field.size() - inside);
  const VecX carried = patch.patch.displacements(given, VecX::Zero(inside));
  EXPECT_LT((carried - field.head(inside)).norm(), 1e-10 * field.norm());

  const VecX forces = VecX::LinSpaced(inside, -1.0, 2.0);
  const VecX pushed = patch.patch.displacements(given, forces);
  VecX together(field.size());
  together << pushed, given;
  EXPECT_LT((patch.K * together - forces).norm(), 1e-10 * forces.norm());
}

}  // namespace
}  // namespace stylet
