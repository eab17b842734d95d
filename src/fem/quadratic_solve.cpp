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

/// Tolerance: norm of the residual / norm of the load. The motion of a target is then that of the factor of K to
/// 1e-7 (VolumeResponse.on_quadratic_elements_*); raised, it is computed sooner.
constexpr double kTolerance = 1e-7;
/// A correction, which is solved for in single precision, leaves this part of the residual or what the tolerance
/// allows. Lowered, rounding takes part in it.
constexpr double kOfCorrection = 1e-3;
/// A correction aims at this part of the tolerance, since its own residual contains rounding. Raised, another
/// correction may be needed.
constexpr double kSpare = 0.5;
/// After this many iterations for a correction, or this many corrections, the factor of K is made instead.
constexpr int kMostIterations = 1000;
constexpr int kMostCorrections = 10;

/// Each load has its own conjugate gradient iteration.
template <class Scalar>
using Scalars = Eigen::Array<Scalar, 1, kSideBySide>;

template <class Scalar>
Scalars<Scalar> products(const Loads<Scalar>& a, const Loads<Scalar>& b) {
  Scalars<Scalar> sum = Scalars<Scalar>::Zero();
  for (Eigen::Index row = 0; row < a.rows(); ++row) sum += a.row(row).array() * b.row(row).array();
  return sum;
}

/// A load of zero, or one that has converged exactly, would divide by zero.
template <class Scalar>
Scalars<Scalar> ratio(const Scalars<Scalar>& a, const Scalars<Scalar>& b) {
  return (b > Scalar(0)).select(a / b, Scalar(0));
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
      inverse_diagonal_.emplace_back(block.inverse().cast<float>());
    }
  }

  /// An approximation of K⁻¹ r: the solution of linear elements for r, plus the inverse diagonal block of each node.
  void apply(const Loads<float>& r, Loads<float>& z) const {
    const Eigen::Index rows = 3 * Eigen::Index{linear_.displacement_nodes()};
    Loads<float> corners = Loads<float>::Zero(rows, kSideBySide);
    for_each_free([&](Eigen::Index dof, Eigen::Index one, Eigen::Index other) {
      corners.middleRows<3>(one) += 0.5F * r.middleRows<3>(dof);
      corners.middleRows<3>(other) += 0.5F * r.middleRows<3>(dof);
    });
    corners = linear_.solve(corners.cast<double>()).cast<float>();
    for_each_free([&](Eigen::Index dof, Eigen::Index one, Eigen::Index other) {
      z.middleRows<3>(dof).noalias() =
          inverse_diagonal_[static_cast<std::size_t>(dof / 3)].lazyProduct(r.middleRows<3>(dof));
      z.middleRows<3>(dof) += 0.5F * (corners.middleRows<3>(one) + corners.middleRows<3>(other));
    });
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
  std::vector<Eigen::Matrix3f> inverse_diagonal_;
};

/// Solves K x = r by conjugate gradients. @param r (free × kSideBySide) changed @param x written
/// @param wanted residual that x may leave, over that at the start
/// @param iterated called before each iteration with the largest residual that is left, over that at the start
/// @return whether x reached it
template <class Iterated>
bool correct(const BlockProduct<float>& stiffness, const TwoLevels& preconditioned, const Scalars<float>& wanted,
             Loads<float>& r, Loads<float>& x, const Iterated& iterated) {
  const Scalars<float> start = products(r, r);
  const Scalars<float> allowed = wanted.square() * start;
  x.setZero(r.rows(), kSideBySide);
  Loads<float> z(r.rows(), kSideBySide);
  preconditioned.apply(r, z);
  Loads<float> p = z;
  Loads<float> Kp(r.rows(), kSideBySide);
  Scalars<float> rz = products(r, z);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Scalars<float> left = products(r, r);
    if ((left <= allowed).all()) return true;
    iterated(std::sqrt(ratio(left, start).maxCoeff()));
    stiffness.multiply(p, Kp);
    const Scalars<float> step = ratio(rz, products(p, Kp));
    x.array() += p.array().rowwise() * step;
    r.array() -= Kp.array().rowwise() * step;
    preconditioned.apply(r, z);
    const Scalars<float> rz_before = std::exchange(rz, products(r, z));
    const Scalars<float> more = ratio(rz, rz_before);
    p.array() = z.array() + p.array().rowwise() * more;
  }
  return false;
}

/// Solves K x = r by corrections in single precision, whose residuals are in double precision.
/// @return whether x reached the tolerance
bool iterate(const Assembled& assembled, const TwoLevels& preconditioned, Loads<double> r, Loads<double>& x,
             const Progress& progress) {
  const BlockProduct<float> single(assembled);
  const BlockProduct<double> whole(assembled);
  const Loads<double> load = r;
  const Scalars<double> size = products(load, load).sqrt();
  x.setZero(r.rows(), kSideBySide);
  Loads<float> scaled(r.rows(), kSideBySide);
  Loads<float> correction(r.rows(), kSideBySide);
  for (int k = 0; k < kMostCorrections; ++k) {
    const Scalars<double> left = products(r, r).sqrt();
    if ((left <= kTolerance * size).all()) return true;
    const double largest = ratio(left, size).maxCoeff();
    const auto iterated = [&](double of_correction) {
      report(progress, "motion of the target",
             std::clamp(std::log(largest * of_correction) / std::log(kTolerance), 0.0, 1.0));
    };
    // A column without a residual stays zero.
    const Scalars<double> to_one = ratio<double>(Scalars<double>::Ones(), left);
    scaled = (r.array().rowwise() * to_one).matrix().cast<float>();
    const Scalars<float> wanted = (kSpare * kTolerance * ratio(size, left)).max(kOfCorrection).min(1.0).cast<float>();
    if (!correct(single, preconditioned, wanted, scaled, correction, iterated)) return false;
    x.array() += correction.cast<double>().array().rowwise() * left;
    whole.multiply(x, r);
    r = load - r;
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
    Loads<double> load = Loads<double>::Zero(free_dofs, kSideBySide);
    for_each_free(
        [&](Eigen::Index at, Eigen::Index dof) { load.block(dof, 0, 3, count) = f.block(at, first, 3, count); });
    Loads<double> x;
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
