// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/shifted_factor.hpp"

#include "core/dense_cholesky.hpp"

namespace stylet::beam {

namespace {

/// The smallest shift that is tried. A larger one takes fewer attempts just beyond the buckling load, but exceeds the
/// necessary shift by more.
constexpr double kSmallestShift = 0.05;

/// A matrix that needs a larger shift is assumed not to be finite. A larger limit takes more attempts before that.
constexpr double kLargestShift = 1e12;

}  // namespace

ShiftedFactor::ShiftedFactor(Eigen::Index size) : H_(MatX::Zero(size, size)), L_(MatX::Identity(size, size)) {}

bool ShiftedFactor::attempt(double shift) {
  L_.triangularView<Eigen::Lower>() = H_;
  L_.diagonal().array() += shift;
  shift_ = shift;
  return dense::factorise(L_);
}

bool ShiftedFactor::factorise(Indefinite otherwise) {
  factorised_ = true;
  if (attempt(0.0)) return true;
  if (otherwise == Indefinite::give_up) return factorised_ = false;
  // The first shift that works bounds the smallest eigenvalue; twice that shift leaves a margin.
  for (double shift = kSmallestShift; shift < kLargestShift; shift *= 2.0) {
    if (attempt(shift) && attempt(2.0 * shift)) return true;
  }
  // Only reached when the matrix is not finite.
  L_.setIdentity();
  return true;
}

// NOLINTBEGIN(performance-unnecessary-value-param): Y is written through the view
void ShiftedFactor::solve_lower(Eigen::Index start, Eigen::Ref<MatX> Y) const { dense::solve_lower(L_, start, Y); }

void ShiftedFactor::solve_upper(Eigen::Ref<MatX> Y) const { dense::solve_upper(L_, Y); }
// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet::beam
