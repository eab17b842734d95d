// SPDX-License-Identifier: GPL-3.0-or-later
#include "quadratic_solve.hpp"

#include "assembly.hpp"
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

/// Several loads side by side: each has its own conjugate gradient iteration, and one pass over K serves all of them.
using Loads = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Scalars = Eigen::Array<double, 1, Eigen::Dynamic>;

Scalars products(const Loads& a, const Loads& b) { return a.cwiseProduct(b).colwise().sum().array(); }

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

/// The same matrix in row-major storage: K is symmetric to the last bit, so its columns are its rows.
using Rows = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>;
Rows rows_of(const Eigen::SparseMatrix<double>& K) {
  return {K.rows(), K.cols(), K.nonZeros(), K.outerIndexPtr(), K.innerIndexPtr(), K.valuePtr()};
}

/// @return whether x reached the tolerance within kMostIterations
bool iterate(const Rows& K, const TwoLevels& preconditioned, Loads r, Loads& x, const Progress& progress) {
  const Scalars wanted = kTolerance * kTolerance * products(r, r);
  x = Loads::Zero(r.rows(), r.cols());
  Loads z = preconditioned(r);
  Loads p = z;
  Loads Kp(r.rows(), r.cols());
  Scalars rz = products(r, z);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Scalars left = products(r, r);
    if ((left <= wanted).all()) return true;
    const double worst = (wanted > 0.0).select(left / wanted, 1.0).maxCoeff();
    report(progress, "motion of the target",
           std::clamp(1.0 + std::log(worst) / (2.0 * std::log(kTolerance)), 0.0, 1.0));
    Kp.noalias() = K * p;
    // A load of zero, or one that has converged exactly, would divide by zero.
    const auto ratio = [](const Scalars& a, const Scalars& b) -> Scalars { return (b > 0.0).select(a / b, 0.0); };
    const Scalars step = ratio(rz, products(p, Kp));
    x += p * step.matrix().asDiagonal();
    r -= Kp * step.matrix().asDiagonal();
    z = preconditioned(r);
    const Scalars rz_before = std::exchange(rz, products(r, z));
    p = (z + p * ratio(rz, rz_before).matrix().asDiagonal()).eval();
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
  Loads load(free_dofs, f.cols());
  const auto for_each_free = [&](const auto& visit) {
    for (Index node = 0; node < quadratic.nodes(); ++node) {
      const Eigen::Index dof = first_dof[static_cast<std::size_t>(node)];
      if (dof >= 0) visit(3 * Eigen::Index{node}, dof);
    }
  };
  for_each_free([&](Eigen::Index at, Eigen::Index dof) { load.middleRows<3>(dof) = f.middleRows<3>(at); });
  Loads x;
  if (!iterate(rows_of(assembled.K), TwoLevels(quadratic, *linear, first_dof, assembled.K), std::move(load), x,
               progress)) {
    const auto tissue = Tissue::build(mesh, materials, fixed, progress, Element::p2);
    if (!tissue) return tissue.error();
    return tissue->solve(f);
  }
  MatX u = MatX::Zero(f.rows(), f.cols());
  for_each_free([&](Eigen::Index at, Eigen::Index dof) { u.middleRows<3>(at) = x.middleRows<3>(dof); });
  return u;
}

}  // namespace stylet::detail
