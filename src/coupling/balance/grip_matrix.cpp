// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/grip_matrix.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet {

namespace {

/// A relative change of D below this is ignored; it adds to the error of the next iteration. Raised, the matrix is
/// factorised less often, and iterations converge more slowly.
constexpr double kNoChange = 1e-3;

/// D that an old matrix may have in a wrong direction, because the contact has turned, relative to the contact's
/// compliance. Raised, the matrix is made anew less often, and iterations converge more slowly.
constexpr double kTurned = 0.1;

/// Contacts that may be appended before the matrix is made anew. All rows of appended contacts are yielding rows.
/// Raised, the matrix is made anew less often, and the part that is factorised in every iteration is larger.
constexpr int kMostAppended = 8;

bool differs(double now, double then) { return std::abs(now - then) > kNoChange * std::max(now, then); }

}  // namespace

GripMatrix::GripMatrix(int grips)
    : rows_(grips),
      springs_(grips),
      yields_(static_cast<std::size_t>(grips)),
      compliance_(static_cast<std::size_t>(grips)),
      yielding_(3 * static_cast<Eigen::Index>(grips), 2 * static_cast<Eigen::Index>(grips), kMostColumns) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(grips);
  const Eigen::Index s = 2 * static_cast<Eigen::Index>(grips);
  factor_ = MatX::Zero(dense::column_length(n + s), n + s);
  work_ = MatX::Zero(n + s, kMostColumns);
  sum_ = turned_ = MatX::Zero(n, 3);
}

/// P + N among the contacts, without D.
void GripMatrix::fill_contacts(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N) {
  for (int h = 0; h < rows_.grips(); ++h) {
    const Eigen::Index down = rows_.grip_rows() - 3 * h;
    auto both = sum_.topRows(down);
    both.noalias() = A.block(3 * h, 3 * h, down, 3) + N.block(3 * h, 3 * h, down, 3);
    auto columns = turned_.topRows(down);
    columns.noalias() = both.lazyProduct(rows_.frame(h));
    for (int g = h; g < rows_.grips(); ++g) {
      const Mat3 block = rows_.frame(g).transpose() * columns.middleRows<3>(3 * (g - h));
      if (g == h) compliance_[static_cast<std::size_t>(h)] = block.trace() / 3.0;
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) lower(rows_.place(g, i), rows_.place(h, j)) = block(i, j);
      }
    }
  }
}

/// P E and Eᵀ P E − K⁻¹, without D.
void GripMatrix::fill_springs(const Eigen::Ref<const MatX>& A) {
  for (int s = 0; s < springs_.count(); ++s) {
    const Eigen::Index at = spring_place(s);
    auto columns = turned_.leftCols<2>().topRows(rows_.grip_rows());
    columns.noalias() = A.middleCols<3>(3 * springs_.grip(s)).lazyProduct(springs_.directions(s));
    for (int g = 0; g < rows_.grips(); ++g) {
      const Eigen::Matrix<double, 3, 2> block = rows_.frame(g).transpose() * columns.middleRows<3>(3 * g);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 2; ++j) lower(rows_.place(g, i), at + j) = block(i, j);
      }
    }
    for (int r = s; r < springs_.count(); ++r) {
      factor_.block<2, 2>(spring_place(r), at).noalias() =
          springs_.directions(r).transpose() * columns.middleRows<3>(3 * springs_.grip(r));
    }
    factor_.block<2, 2>(at, at).diagonal().array() -= springs_.flexibility(s);
  }
}

/// Passes the yielding rows their D and the springs' directions.
void GripMatrix::begin_yielding() {
  yielding_.begin(rows_.spring_rows());
  for (int g = 0; g < rows_.grips(); ++g) {
    for (int k = 0; k < 3; ++k) {
      if (!rows_.settled(g, k)) yielding_.add_row(yields_[static_cast<std::size_t>(g)].component(k));
    }
  }
  for (int s = 0; s < springs_.count(); ++s) {
    const int g = springs_.grip(s);
    const Eigen::Matrix<double, 3, 2> local = rows_.frame(g).transpose() * springs_.directions(s);
    for (int k = 0; k < 3; ++k) {
      if (!rows_.settled(g, k))
        yielding_.add_direction(rows_.place(g, k) - rows_.first_yielding(), 2 * s, local.row(k));
    }
  }
}

bool GripMatrix::factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                           std::span<const LentSpring> springs, std::span<const Yield> yields) {
  fill(A, N, springs, yields);
  return factorise_filled();
}

void GripMatrix::fill(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                      std::span<const LentSpring> springs, std::span<const Yield> yields) {
  assert(A.rows() == 3 * static_cast<Eigen::Index>(yields.size()));
  std::copy(yields.begin(), yields.end(), yields_.begin());
  springs_.take(springs);
  rows_.arrange(yields, springs_.rows());
  fill_contacts(A, N);
  fill_springs(A);
  begin_yielding();
  appended_ = 0;
}

bool GripMatrix::factorise_filled() {
  return dense::factorise_first(factor_.topLeftCorner(rows(), rows()), rows_.settled());
}

bool GripMatrix::append(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, const Yield& yield) {
  assert(A.rows() == rows_.grip_rows() + 3 && N.rows() == rows_.grip_rows() + 3);
  if (appended_ == kMostAppended) return false;
  ++appended_;
  const int last = rows_.grips();
  const auto l = static_cast<std::size_t>(last);
  rows_.append(yield.along);
  yields_[l] = yield;
  for (int k = 0; k < 3; ++k) yielding_.add_row(yield.component(k));

  // The contact's columns of B in the order of elimination; then its rows of L in the settled columns; then its Schur
  // complement.
  const Eigen::Index settled = rows_.settled();
  const Eigen::Index unsettled = rows_.unsettled();
  const Eigen::Index at = rows() - 3;
  auto columns = work_.topLeftCorner(rows(), 3);
  auto turned = turned_.topRows(rows_.grip_rows());
  turned.noalias() = A.middleCols<3>(3 * last).lazyProduct(rows_.frame(last));
  for (int s = 0; s < springs_.count(); ++s)
    columns.middleRows<2>(spring_place(s)).noalias() =
        springs_.directions(s).transpose() * turned.middleRows<3>(3 * springs_.grip(s));
  turned.noalias() += N.middleCols<3>(3 * last).lazyProduct(rows_.frame(last));
  for (int g = 0; g < rows_.grips(); ++g) {
    const Mat3 block = rows_.frame(g).transpose() * turned.middleRows<3>(3 * g);
    for (int i = 0; i < 3; ++i) columns.row(rows_.place(g, i)) = block.row(i);
  }
  compliance_[l] = columns.bottomRows<3>().trace() / 3.0;
  auto in_L = columns.topRows(settled);
  dense::solve_lower(factor_.topLeftCorner(settled, settled), 0, in_L);
  factor_.block(at, 0, 3, settled) = in_L.transpose();
  auto rest = columns.bottomRows(unsettled);
  dense::subtract_product(rest, factor_.block(settled, 0, unsettled, settled), in_L);
  factor_.block(at, settled, 3, unsettled) = rest.transpose();
  return true;
}

bool GripMatrix::keep_first(int grips) {
  assert(grips <= rows_.grips());
  for (int g = grips; g < rows_.grips(); ++g) {
    if (rows_.settled(g, 0)) return false;
  }
  if (!springs_.are_among_first(grips)) return false;
  rows_.keep_first(grips);
  yielding_.keep_first(rows() - rows_.first_yielding());
  return true;
}

bool GripMatrix::change(std::span<const Yield> yields) {
  for (int g = 0; g < rows_.grips(); ++g) {
    const Yield& now = yields[static_cast<std::size_t>(g)];
    Yield& then = yields_[static_cast<std::size_t>(g)];
    const double sideways = std::abs(now.axial - now.lateral) * (now.along - then.along).norm();
    if (sideways > kTurned * (compliance_[static_cast<std::size_t>(g)] + now.lateral)) return false;
    if (differs(now.lateral, then.lateral)) {
      if (rows_.settled(g, 0)) return false;
      then.lateral = now.lateral;
      set_yield(g, 0, now.lateral);
      set_yield(g, 1, now.lateral);
    }
    if (differs(now.axial, then.axial)) {
      then.axial = now.axial;
      set_yield(g, 2, now.axial);
    }
  }
  if (yielding_.factorised()) return true;
  ++version_;
  return yielding_.factorise(factor_.block(rows_.settled(), rows_.settled(), rows_.unsettled(), rows_.unsettled()));
}

void GripMatrix::set_yield(int grip, int k, double value) {
  yielding_.set_yield(rows_.place(grip, k) - rows_.first_yielding(), value);
}

// NOLINTBEGIN(performance-unnecessary-value-param): Y is written through the view

void GripMatrix::begin(Eigen::Ref<MatX> Y) {
  const Eigen::Index settled = rows_.settled();
  const Eigen::Index unsettled = rows_.unsettled();
  auto ordered = work_.topLeftCorner(rows(), Y.cols());
  rows_.order(Y, ordered);
  dense::solve_lower(factor_.topLeftCorner(settled, settled), 0, ordered.topRows(settled));
  dense::subtract_product(ordered.bottomRows(unsettled), factor_.block(settled, 0, unsettled, settled),
                          ordered.topRows(settled));
  Y = ordered;
}

void GripMatrix::finish(Eigen::Ref<MatX> Y) {
  const Eigen::Index settled = rows_.settled();
  const Eigen::Index unsettled = rows_.unsettled();
  yielding_.solve(Y.bottomRows(unsettled));
  auto known = work_.topLeftCorner(settled, Y.cols());
  dense::transposed_product(known, factor_.block(settled, 0, unsettled, settled), Y.bottomRows(unsettled));
  Y.topRows(settled) -= known;
  dense::solve_upper(factor_.topLeftCorner(settled, settled), Y.topRows(settled));

  auto ordered = work_.topLeftCorner(rows(), Y.cols());
  ordered = Y;
  rows_.restore(ordered, Y);
}

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet
