// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/reproduce/plane_tissue.hpp"
#include "stylet/evidence/reproduce/figure5.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>

using namespace stylet;
using namespace stylet::reproduce;

TEST(Figure5, every_method_gives_the_inverse_from_scratch) {
  const auto rows = measure_figure5({30, 60, 120, 250}, 0.0);
  ASSERT_TRUE(rows.ok()) << rows.error().message();
  ASSERT_EQ(rows->size(), 4u);
  const std::vector<int> wanted{30, 60, 120, 250};
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const Figure5Row& row = (*rows)[i];
    EXPECT_NEAR(row.dim, wanted[i], 0.15 * wanted[i]);
    EXPECT_EQ(row.change, 10);
    EXPECT_EQ(row.added, 2);
    EXPECT_NEAR(row.bcs_multiplications / row.dim, (2 * 10 - 2) * (row.dim + 1), 30.0);
    EXPECT_LT(row.woodbury_multiplications, row.bcs_multiplications);
    EXPECT_LT(row.largest_error, 1e-11);
    EXPECT_GE(row.repeats, 3);
    for (const double seconds : {row.inverse_s, row.bcs_s, row.woodbury_s, row.woodbury_symmetric_s})
      EXPECT_GT(seconds, 0.0);
  }
}

TEST(Figure5, sizes_span_the_papers_range) {
  const std::vector<int> dims = figure5_dims(false);
  EXPECT_EQ(dims.front(), 50);
  EXPECT_EQ(dims.back(), 2000);
  EXPECT_GE(dims.size(), 8u);
}

TEST(PlaneTissue, stretches_as_plane_strain_does) {
  // Linear triangles can represent a homogeneous strain, so its energy is exact on every grid.
  const PlaneTissue tissue = plane_tissue(4, 3);
  const double e = 0.01;
  double energy = 0.0;
  for (const auto& triangle : tissue.triangles) {
    Eigen::Matrix<double, 6, 1> u;
    for (int i = 0; i < 3; ++i)
      u.segment<2>(2 * i) << e * tissue.nodes[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])].x(), 0.0;
    energy += 0.5 * u.dot(triangle_stiffness(tissue, triangle) * u);
  }
  const double E = PlaneTissue::kYoung_MPa;
  const double nu = PlaneTissue::kPoisson;
  const double modulus = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  EXPECT_NEAR(energy, 0.5 * modulus * e * e * PlaneTissue::kSide_mm * PlaneTissue::kSide_mm, 1e-12 * modulus);
}

TEST(PlaneTissue, adding_a_node_changes_the_stiffness_by_what_is_said) {
  PlaneTissue tissue = plane_tissue(4, 3);
  const MatX before = stiffness(tissue);
  const StiffnessChange change = add_node_in_the_middle(tissue);
  MatX after = stiffness(tissue);
  EXPECT_EQ(tissue.dofs(), before.rows() + 2);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(after).eigenvalues().minCoeff(), 0.0);
  after.topLeftCorner(before.rows(), before.rows()) -= before;
  for (std::size_t i = 0; i < change.dofs.size(); ++i)
    for (std::size_t j = 0; j < change.dofs.size(); ++j)
      after(change.dofs[i], change.dofs[j]) -=
          change.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  EXPECT_LT(after.cwiseAbs().maxCoeff(), 1e-15);
}
