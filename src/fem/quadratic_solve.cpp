// SPDX-License-Identifier: GPL-3.0-or-later
#include "quadratic_solve.hpp"

#include "block_product.hpp"
#include "stylet/fem/tissue.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet::detail {
namespace {

/// Tolerance: norm of the residual / norm of the load.
constexpr double kTolerance = 1e-8;
/// After this many iterations the factor of K is made instead.
constexpr int kMostIterations = 1000;

/// Each load has its own conjugate gradient iteration.
using Scalars = Eigen::Array<double, 1, kSideBySide>;

Scalars products(const Loads& a, const Loads& b) {
  Scalars sum = Scalars::Zero();
  for (Eigen::Index row = 0; row < a.rows(); ++row) sum += a.row(row).array() * b.row(row).array();
  return sum;
}

class TwoLevels {
 public:
  TwoLevels(const Discretisation& quadratic, const Tissue& linear, const std::vector<Index>& first_dof,
            const Eigen::SparseMatrix<double>& K)
      : quadratic_(quadratic), linear_(linear), first_dof_(first_dof) {
    inverse_diagonal_.reserve(static_cast<std::size_t>(K.rows() / 3));
    for (Eigen::Index dof = 0; dof < K.rows(); dof += 3) {
      Mat3 block;
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) block(i, j) = K.coeff(dof + i, dof + j);
      }
      inverse_diagonal_.emplace_back(block.inverse());
    }
  }

  /// An approximation of K⁻¹ r: the solution of linear elements for r, plus the inverse diagonal block of each node.
  [[nodiscard]] Loads operator()(const Loads& r) const {
    MatX on_corners = MatX::Zero(3 * Eigen::Index{linear_.displacement_nodes()}, r.cols());
    for_each_free([&](Eigen::Index dof, Eigen::Index one, Eigen::Index other) {
      on_corners.middleRows<3>(one) += 0.5 * r.middleRows<3>(dof);
      on_corners.middleRows<3>(other) += 0.5 * r.middleRows<3>(dof);
    });
    const MatX u = linear_.solve(on_corners);
    Loads z(r.rows(), r.cols());
    for_each_free([&](Eigen::Index dof, Eigen::Index one, Eigen::Index other) {
      z.middleRows<3>(dof).noalias() =
          inverse_diagonal_[static_cast<std::size_t>(dof / 3)].lazyProduct(r.middleRows<3>(dof));
      z.middleRows<3>(dof) += 0.5 * (u.middleRows<3>(one) + u.middleRows<3>(other));
    });
    return z;
  }

 private:
  /// Calls visit(first degree of freedom, first row of one end, first row of the other end) for every free node. A
  /// linear field at a node is the mean of its values at the node's two ends.
  template <class Visit>
  void for_each_free(const Visit& visit) const {
    for (Index node = 0; node < quadratic_.nodes(); ++node) {
      const Eigen::Index dof = first_dof_[static_cast<std::size_t>(node)];
      if (dof < 0) continue;
      const auto [one, other] = quadratic_.ends(node);
      visit(dof, 3 * Eigen::Index{one}, 3 * Eigen::Index{other});
    }
  }

  const Discretisation& quadratic_;
  const Tissue& linear_;
  const std::vector<Index>& first_dof_;
  std::vector<Mat3> inverse_diagonal_;
};

/// @return whether x reached the tolerance within kMostIterations
bool iterate(const Assembled& stiffness, const TwoLevels& preconditioned, Loads r, Loads& x, const Progress& progress) {
  const Scalars wanted = kTolerance * kTolerance * products(r, r);
  x = Loads::Zero(r.rows(), kSideBySide);
  Loads z = preconditioned(r);
  Loads p = z;
  Loads Kp(r.rows(), kSideBySide);
  Scalars rz = products(r, z);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Scalars left = products(r, r);
    if ((left <= wanted).all()) return true;
    const double worst = (wanted > 0.0).select(left / wanted, 1.0).maxCoeff();
    report(progress, "motion of the target",
           std::clamp(1.0 + std::log(worst) / (2.0 * std::log(kTolerance)), 0.0, 1.0));
    multiply(stiffness, p, Kp);
    // A load of zero, or one that has converged exactly, would divide by zero.
    const auto ratio = [](const Scalars& a, const Scalars& b) -> Scalars { return (b > 0.0).select(a / b, 0.0); };
    const Scalars step = ratio(rz, products(p, Kp));
    x.array() += p.array().rowwise() * step;
    r.array() -= Kp.array().rowwise() * step;
    z = preconditioned(r);
    const Scalars rz_before = std::exchange(rz, products(r, z));
    const Scalars more = ratio(rz, rz_before);
    p.array() = z.array() + p.array().rowwise() * more;
  }
  return false;
}

}  // namespace

Result<MatX> solve_quadratic(const Discretisation& quadratic, const TetMesh& mesh,
                             const std::vector<Material>& materials, const std::vector<Index>& fixed, const MatX& f,
                             const Progress& progress) {
  const auto linear = Tissue::build(mesh, materials, fixed, progress, Element::p1);
  if (!linear) return linear.error();
  std::vector<Index> first_dof(static_cast<std::size_t>(quadratic.nodes()), -1);
  Index free_dofs = 0;
  for (Index node = 0; node < quadratic.nodes(); ++node) {
    const auto [one, other] = quadratic.ends(node);
    if (linear->is_fixed(one) && linear->is_fixed(other)) continue;
    first_dof[static_cast<std::size_t>(node)] = free_dofs;
    free_dofs += 3;
  }
  report(progress, "assembling", 0.0);
  const Assembled assembled = assemble(
      quadratic, mesh.tet_count(),
      [&](Index tet) { return materials[static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(tet)])]; },
      first_dof, free_dofs);
  const auto for_each_free = [&](const auto& visit) {
    for (Index node = 0; node < quadratic.nodes(); ++node) {
      const Eigen::Index dof = first_dof[static_cast<std::size_t>(node)];
      if (dof >= 0) visit(3 * Eigen::Index{node}, dof);
    }
  };
  const TwoLevels preconditioned(quadratic, *linear, first_dof, assembled.K);
  MatX u = MatX::Zero(f.rows(), f.cols());
  for (Eigen::Index first = 0; first < f.cols(); first += kSideBySide) {
    const Eigen::Index count = std::min<Eigen::Index>(kSideBySide, f.cols() - first);
    Loads load = Loads::Zero(free_dofs, kSideBySide);
    for_each_free(
        [&](Eigen::Index at, Eigen::Index dof) { load.block(dof, 0, 3, count) = f.block(at, first, 3, count); });
    Loads x;
    if (!iterate(assembled, preconditioned, std::move(load), x, progress)) {
      const auto tissue = Tissue::build(mesh, materials, fixed, progress, Element::p2);
      if (!tissue) return tissue.error();
      return tissue->solve(f);
    }
    for_each_free([&](Eigen::Index at, Eigen::Index dof) { u.block(at, first, 3, count) = x.block(dof, 0, 3, count); });
  }
  return u;
}

}  // namespace stylet::detail
