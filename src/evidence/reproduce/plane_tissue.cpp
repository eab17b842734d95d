// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane_tissue.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace stylet::reproduce {

PlaneTissue plane_tissue(int deep, int across) {
  PlaneTissue tissue;
  tissue.held = across + 1;
  for (int i = 0; i <= deep; ++i) {
    for (int j = 0; j <= across; ++j) {
      tissue.nodes.emplace_back(PlaneTissue::kSide_mm * i / deep, PlaneTissue::kSide_mm * j / across);
    }
  }
  for (int i = 0; i < deep; ++i) {
    for (int j = 0; j < across; ++j) {
      const Index a = i * (across + 1) + j;
      const Index b = a + across + 1;
      tissue.triangles.push_back({a, b, b + 1});
      tissue.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return tissue;
}

Eigen::Matrix<double, 6, 6> triangle_stiffness(const PlaneTissue& tissue, const std::array<Index, 3>& triangle) {
  const auto corner = [&](std::size_t i) { return tissue.nodes[static_cast<std::size_t>(triangle[i])]; };
  Eigen::Matrix2d edges;
  edges << corner(1) - corner(0), corner(2) - corner(0);
  const double area = 0.5 * edges.determinant();
  const Eigen::Matrix2d inverse = edges.inverse();
  Eigen::Matrix<double, 2, 3> gradient;  // of the barycentric coordinates [1/mm]
  gradient.col(1) = inverse.row(0).transpose();
  gradient.col(2) = inverse.row(1).transpose();
  gradient.col(0) = -gradient.col(1) - gradient.col(2);

  Eigen::Matrix<double, 3, 6> B = Eigen::Matrix<double, 3, 6>::Zero();  // xx, yy, 2 xy
  for (int i = 0; i < 3; ++i) {
    B(0, 2 * i) = B(2, 2 * i + 1) = gradient(0, i);
    B(1, 2 * i + 1) = B(2, 2 * i) = gradient(1, i);
  }
  constexpr double E = PlaneTissue::kYoung_MPa;
  constexpr double nu = PlaneTissue::kPoisson;
  constexpr double mu = E / (2 * (1 + nu));
  constexpr double lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  Eigen::Matrix3d D;
  D << lambda + 2 * mu, lambda, 0, lambda, lambda + 2 * mu, 0, 0, 0, mu;
  return area * B.transpose() * D * B;
}

MatX stiffness(const PlaneTissue& tissue) {
  MatX K = MatX::Zero(tissue.dofs(), tissue.dofs());
  for (const auto& triangle : tissue.triangles) {
    const auto block = triangle_stiffness(tissue, triangle);
    for (int a = 0; a < 3; ++a) {
      const Index row = tissue.first_dof(triangle[static_cast<std::size_t>(a)]);
      if (row < 0) continue;
      for (int b = 0; b < 3; ++b) {
        const Index column = tissue.first_dof(triangle[static_cast<std::size_t>(b)]);
        if (column >= 0) K.block<2, 2>(row, column) += block.block<2, 2>(2 * a, 2 * b);
      }
    }
  }
  return K;
}

namespace {

void add_triangle(StiffnessChange& change, const PlaneTissue& tissue, const std::array<Index, 3>& triangle,
                  double sign) {
  const auto block = triangle_stiffness(tissue, triangle);
  std::array<Eigen::Index, 6> at{};  // position of each degree of freedom of the triangle in ΔK, −1 if held
  for (std::size_t i = 0; i < 6; ++i) {
    const Index first = tissue.first_dof(triangle[i / 2]);
    const Index dof = first + static_cast<Index>(i % 2);
    const auto found = std::lower_bound(change.dofs.begin(), change.dofs.end(), dof);
    at[i] = first < 0 ? -1 : found - change.dofs.begin();
  }
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      if (at[i] >= 0 && at[j] >= 0)
        change.values(at[i], at[j]) += sign * block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

}  // namespace

StiffnessChange add_node_in_the_middle(PlaneTissue& tissue) {
  // The two triangles (a, b, c) and (a, c, d) of a cell share the edge a c.
  const Index across = tissue.held - 1;
  const Index deep = static_cast<Index>(tissue.nodes.size()) / tissue.held - 1;
  const auto cell = 2 * static_cast<std::size_t>((deep / 2) * across + across / 2);
  const auto [a, b, c] = tissue.triangles[cell];
  const Index d = tissue.triangles[cell + 1][2];
  const auto node = static_cast<Index>(tissue.nodes.size());
  const Vec2 at = 0.55 * tissue.nodes[static_cast<std::size_t>(a)] + 0.45 * tissue.nodes[static_cast<std::size_t>(c)];
  tissue.nodes.push_back(at);

  StiffnessChange change;
  for (const Index corner : {a, b, c, d, node}) {
    const Index first = tissue.first_dof(corner);
    if (first >= 0) change.dofs.insert(change.dofs.end(), {first, first + 1});
  }
  std::sort(change.dofs.begin(), change.dofs.end());
  const auto k = static_cast<Eigen::Index>(change.dofs.size());
  change.values = MatX::Zero(k, k);
  add_triangle(change, tissue, {a, b, c}, -1.0);
  add_triangle(change, tissue, {a, c, d}, -1.0);
  tissue.triangles[cell] = {a, b, node};
  tissue.triangles[cell + 1] = {a, node, d};
  tissue.triangles.push_back({b, c, node});
  tissue.triangles.push_back({c, d, node});
  for (const std::size_t t : {cell, cell + 1, tissue.triangles.size() - 2, tissue.triangles.size() - 1})
    add_triangle(change, tissue, tissue.triangles[t], 1.0);
  return change;
}

}  // namespace stylet::reproduce
