// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/held_tissue.hpp"

#include "core/dense_kernels.hpp"

namespace stylet {

HeldTissue::HeldTissue(int grips, int most_others) {
  const Eigen::Index others = 3 * static_cast<Eigen::Index>(grips > 0 ? most_others : 0);
  A_ = solved_ = MatX::Zero(RestingMatrix::most_rows(grips), others);
  of_sliding_ = slipped_ = MatX::Zero(grips, others);
  whole_ = reduction_ = MatX::Zero(others, others);
}

void HeldTissue::clear() {
  known_ = 1;
  for (MatX* const columns : {&A_, &solved_, &of_sliding_, &slipped_}) columns->leftCols<3>().setZero();
  whole_.topLeftCorner<3, 3>().setZero();
  reduction_.topLeftCorner<3, 3>().setZero();
}

/// Writes Sᵀ A for three columns.
void HeldTissue::extend(const Eigen::Ref<const MatX>& A, Eigen::Index at, const RestingMatrix& matrix) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    auto column = A_.col(at + k).head(matrix.rows());
    column.head(matrix.contact_rows()) = A.col(k);
    matrix.fill_springs(column);
  }
}

void HeldTissue::add(const Eigen::Ref<const MatX>& A, RestingMatrix& matrix, const SlidingRows& sliding) {
  next(matrix) = A;
  add_next(matrix, sliding);
}

void HeldTissue::add_next(RestingMatrix& matrix, const SlidingRows& sliding) {
  const Eigen::Index at = others();
  ++known_;
  for (Eigen::Index k = 0; k < 3; ++k) matrix.fill_springs(A_.col(at + k).head(matrix.rows()));
  auto solved = solved_.block(0, at, matrix.rows(), 3);
  solved = A_.block(0, at, matrix.rows(), 3);
  matrix.solve(solved);
  reduce(at, matrix, sliding);
}

void HeldTissue::set_tip(const Eigen::Ref<const MatX>& solved, const RestingMatrix& matrix,
                         const SlidingRows& sliding) {
  solved_.topLeftCorner(matrix.rows(), 3) = solved;
  reduce(0, matrix, sliding);
}

void HeldTissue::follow(const RestingMatrix& matrix, const SlidingRows& sliding) {
  slide(0, others(), matrix, sliding);
}

/// Computes the reduction of three columns.
void HeldTissue::reduce(Eigen::Index first, const RestingMatrix& matrix, const SlidingRows& sliding) {
  auto part = whole_.block(0, first, others(), 3);
  dense::transposed_product(part, A_.topLeftCorner(matrix.rows(), others()), solved_.block(0, first, matrix.rows(), 3));
  whole_.block(first, 0, 3, others()) = part.transpose();
  slide(first, 3, matrix, sliding);
}

/// Computes the share of the sliding contacts in columns of the reduction.
void HeldTissue::slide(Eigen::Index first, Eigen::Index count, const RestingMatrix& matrix,
                       const SlidingRows& sliding) {
  auto part = reduction_.block(0, first, others(), count);
  part = whole_.block(0, first, others(), count);
  if (const Eigen::Index s = sliding.count(); s > 0) {
    auto of = of_sliding_.block(0, first, s, count);
    sliding.take(solved_.block(0, first, matrix.rows(), count), matrix, of);
    auto slipped = slipped_.block(0, first, s, count);
    slipped = of;
    sliding.divide(slipped);
    part.noalias() -= of_sliding_.topLeftCorner(s, others()).transpose().lazyProduct(slipped);
  }
  reduction_.block(first, 0, count, others()) = part.transpose();
}

// NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views

void HeldTissue::motion(const Eigen::Ref<const VecX>& z, const RestingMatrix& matrix, SlidingRows& sliding,
                        Eigen::Ref<VecX> motion) const {
  dense::transposed_product(motion, A_.topLeftCorner(matrix.rows(), others()), z);
  const Eigen::Index s = sliding.count();
  if (s > 0)
    motion.noalias() -= of_sliding_.topLeftCorner(s, others()).transpose().lazyProduct(sliding.slips(z, matrix));
}

void HeldTissue::displacement(const Eigen::Ref<const VecX>& forces, Eigen::Ref<VecX> motion) const {
  dense::transposed_product(motion, A_.topLeftCorner(forces.size(), others()), forces);
}

void HeldTissue::subtract(const Eigen::Ref<const VecX>& forces, Eigen::Ref<VecX> z) const {
  dense::subtract_product(z, solved_.topLeftCorner(z.size(), others()), forces);
}

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet
