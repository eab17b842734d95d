// SPDX-License-Identifier: GPL-3.0-or-later
#include "grip_matrix.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_lu.hpp"
#include "core/dense_product.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// A change of D by less than this part of it goes into the next iteration's error instead.
constexpr double kNoChange = 1e-3;

/// What D gives sideways because its direction is an old one, over what the contact gives way there.
constexpr double kTurned = 0.1;

bool differs(double now, double then) { return std::abs(now - then) > kNoChange * std::max(now, then); }

/// Two directions square to t, and t.
Vec3 direction_of(const Yield& yield, int which) {
  if (which == 2) return yield.along;
  const Vec3 helper = std::abs(yield.along.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 first = yield.along.cross(helper).normalized();
  return which == 0 ? first : Vec3(yield.along.cross(first));
}

}  // namespace

GripMatrix::GripMatrix(int grips)
    : pivots_(static_cast<std::size_t>(3 * grips)),
      own_(static_cast<std::size_t>(grips)),
      yields_(static_cast<std::size_t>(grips)),
      known_(static_cast<std::size_t>(grips)) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(grips);
  factor_ = work_ = G_N_ = MatX::Zero(n, n);
  Z_ = MatX::Zero(n, kMostChanges);
}

bool GripMatrix::factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                           std::span<const Mat3> springs, std::span<const Yield> yields) {
  const Eigen::Index n = A.rows();
  grips_ = static_cast<int>(n / 3);
  supported_ = !springs.empty();
  count_ = 0;
  changed_ = false;
  std::copy(yields.begin(), yields.end(), yields_.begin());
  std::fill(known_.begin(), known_.end(), Eigen::Vector3i::Constant(-1));

  auto B = factor_.topLeftCorner(n, n);
  B = A;
  for (int g = 0; g < grips_; ++g) {
    const Yield& yield = yields_[static_cast<std::size_t>(g)];
    auto block = B.block<3, 3>(3 * g, 3 * g);
    own_[static_cast<std::size_t>(g)] = (block.trace() + N.block<3, 3>(3 * g, 3 * g).trace()) / 3.0;
    block += (yield.axial - yield.lateral) * yield.along * yield.along.transpose();
    block.diagonal().array() += yield.lateral;
  }
  if (!supported_) {
    B += N;
    return dense::factorise(B);
  }
  auto P = work_.topLeftCorner(n, n);
  auto G_N = G_N_.topLeftCorner(n, n);
  P = B;
  for (int g = 0; g < grips_; ++g)
    G_N.middleRows<3>(3 * g).noalias() = springs[static_cast<std::size_t>(g)].lazyProduct(N.middleRows<3>(3 * g));
  B += N;
  dense::subtract_product(B, P, G_N);
  return dense::factorise_lu(B, pivots_);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): Y is written through the view
void GripMatrix::solve_base(Eigen::Ref<MatX> Y) const {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(grips_);
  const auto factor = factor_.topLeftCorner(n, n);
  if (supported_) {
    dense::solve_lu(factor, pivots_, Y);
    return;
  }
  dense::solve_lower(factor, 0, Y);
  dense::solve_upper(factor, Y);
}

/// eᵀ (I − G N) y
double GripMatrix::across(const Direction& d, const Eigen::Ref<const VecX>& y) const {
  double value = d.e.dot(y.segment<3>(3 * d.grip));
  if (supported_) {
    for (int k = 0; k < 3; ++k) value -= d.e[k] * G_N_.row(3 * d.grip + k).head(y.size()).dot(y);
  }
  return value;
}

/// Number of a direction, its column of Z made when it is asked for first; -1 when there is no room.
int GripMatrix::direction(int grip, int which) {
  int& known = known_[static_cast<std::size_t>(grip)][which];
  if (known >= 0) return known;
  if (count_ == kMostChanges) return -1;
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(grips_);
  const int k = count_++;
  Direction& d = directions_[static_cast<std::size_t>(k)];
  d = {grip, direction_of(yields_[static_cast<std::size_t>(grip)], which), 0.0};
  auto z = Z_.col(k).head(n);
  z.setZero();
  z.segment<3>(3 * grip) = d.e;
  solve_base(z);
  F_Z_.conservativeResize(count_, count_);
  for (int i = 0; i < count_; ++i) {
    F_Z_(i, k) = across(directions_[static_cast<std::size_t>(i)], z);
    F_Z_(k, i) = across(d, Z_.col(i).head(n));
  }
  known = k;
  return k;
}

bool GripMatrix::change(std::span<const Yield> yields) {
  int needed = count_;
  for (int g = 0; g < grips_; ++g) {
    const Yield& now = yields[static_cast<std::size_t>(g)];
    const Yield& then = yields_[static_cast<std::size_t>(g)];
    const auto& known = known_[static_cast<std::size_t>(g)];
    const double sideways = std::abs(now.axial - now.lateral) * (now.along - then.along).norm();
    if (sideways > kTurned * (own_[static_cast<std::size_t>(g)] + now.lateral)) return false;
    if (differs(now.lateral, then.lateral)) needed += (known[0] < 0 ? 1 : 0) + (known[1] < 0 ? 1 : 0);
    if (differs(now.axial, then.axial) && known[2] < 0) ++needed;
  }
  if (needed > kMostChanges) return false;
  changed_ = false;
  for (int k = 0; k < count_; ++k) directions_[static_cast<std::size_t>(k)].change = 0.0;
  for (int g = 0; g < grips_; ++g) {
    const Yield& now = yields[static_cast<std::size_t>(g)];
    const Yield& then = yields_[static_cast<std::size_t>(g)];
    for (int which = 0; which < 3; ++which) {
      const double value = which == 2 ? now.axial : now.lateral;
      const double before = which == 2 ? then.axial : then.lateral;
      if (!differs(value, before)) continue;
      directions_[static_cast<std::size_t>(direction(g, which))].change = value - before;
      changed_ = true;
    }
  }
  return true;
}

bool GripMatrix::keep_first(int grips) {
  if (supported_ || grips > grips_) return false;
  grips_ = grips;
  count_ = 0;
  changed_ = false;
  std::fill(known_.begin(), known_.end(), Eigen::Vector3i::Constant(-1));
  return true;
}

Yield GripMatrix::yield(int grip) const {
  const auto change = [&](int which) {
    const int known = known_[static_cast<std::size_t>(grip)][which];
    return known < 0 ? 0.0 : directions_[static_cast<std::size_t>(known)].change;
  };
  const Yield& then = yields_[static_cast<std::size_t>(grip)];
  return {then.along, then.lateral + change(0), then.axial + change(2)};
}

void GripMatrix::solve(Eigen::Ref<MatX> Y) const {
  solve_base(Y);
  if (!changed_) return;
  // (B + E Δ Fᵀ)⁻¹ = B⁻¹ − Z (I + Δ Fᵀ Z)⁻¹ Δ Fᵀ B⁻¹
  Small small(count_, count_);
  for (int i = 0; i < count_; ++i) {
    small.row(i) = directions_[static_cast<std::size_t>(i)].change * F_Z_.row(i);
    small(i, i) += 1.0;
  }
  const Eigen::PartialPivLU<Small> lu(small);
  for (Eigen::Index c = 0; c < Y.cols(); ++c) {
    SmallVector right(count_);
    for (int i = 0; i < count_; ++i) {
      const Direction& d = directions_[static_cast<std::size_t>(i)];
      right[i] = d.change == 0.0 ? 0.0 : d.change * across(d, Y.col(c));
    }
    const SmallVector amount = lu.solve(right);
    for (int i = 0; i < count_; ++i) Y.col(c) -= amount[i] * Z_.col(i).head(Y.rows());
  }
}

}  // namespace stylet
