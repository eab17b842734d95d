// SPDX-License-Identifier: GPL-3.0-or-later
#include "grip_matrix.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"
#include "core/dense_lu.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet {

namespace {

/// A change of D by less than this part of it goes into the next iteration's error instead.
constexpr double kNoChange = 1e-3;

/// What D gives sideways because its direction is an old one, over what the contact gives way there.
constexpr double kTurned = 0.1;

double component(const Yield& yield, int which) { return which == 2 ? yield.axial : yield.lateral; }

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
  factor_ = P_lent_ = G_N_ = MatX::Zero(n, n);
  row_ = MatX::Zero(3, n);
  lent_.reserve(static_cast<std::size_t>(grips));
  lent_row_.assign(static_cast<std::size_t>(grips), -1);
  Z_ = MatX::Zero(n, kMostChanges);
}

void GripMatrix::forget_changes() {
  count_ = 0;
  changed_ = false;
  std::fill(known_.begin(), known_.end(), Eigen::Vector3i::Constant(-1));
}

bool GripMatrix::factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                           std::span<const Mat3> springs, std::span<const Yield> yields) {
  const Eigen::Index n = A.rows();
  grips_ = static_cast<int>(n / 3);
  supported_ = !springs.empty();
  std::copy(yields.begin(), yields.end(), yields_.begin());
  forget_changes();

  auto B = factor_.topLeftCorner(n, n);
  B = A;
  for (int g = 0; g < grips_; ++g) {
    const Yield& yield = yields_[static_cast<std::size_t>(g)];
    auto block = B.block<3, 3>(3 * g, 3 * g);
    own_[static_cast<std::size_t>(g)] = (block.trace() + N.block<3, 3>(3 * g, 3 * g).trace()) / 3.0;
    block += (yield.axial - yield.lateral) * yield.along * yield.along.transpose();
    block.diagonal().array() += yield.lateral;
  }
  lent_.clear();
  std::fill(lent_row_.begin(), lent_row_.end(), -1);
  if (!supported_) {
    B += N;
    return dense::factorise(B);
  }
  for (int g = 0; g < grips_; ++g) {
    const Mat3& spring = springs[static_cast<std::size_t>(g)];
    if (spring.isZero(0.0)) continue;
    const Eigen::Index at = 3 * static_cast<Eigen::Index>(lent_.size());
    lent_row_[static_cast<std::size_t>(g)] = static_cast<int>(at);
    lent_.push_back(g);
    P_lent_.block(0, at, n, 3) = B.middleCols<3>(3 * g);
    G_N_.block(at, 0, 3, n).noalias() = spring.lazyProduct(N.middleRows<3>(3 * g));
  }
  B += N;
  dense::subtract_product(B, P_lent_.topLeftCorner(n, lent_rows()), G_N_.topLeftCorner(lent_rows(), n));
  return dense::factorise_lu(B, pivots_);
}

bool GripMatrix::append(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, std::span<const Mat3> springs,
                        const Yield& yield) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(grips_);
  assert(A.rows() == n + 3 && N.rows() == n + 3 && springs.empty() == !supported_);
  forget_changes();
  const auto g = static_cast<std::size_t>(grips_++);
  yields_[g] = yield;
  own_[g] = (A.block<3, 3>(n, n).trace() + N.block<3, 3>(n, n).trace()) / 3.0;

  // B = [old  C; R  last], C = Rᵀ without springs
  Mat3 last = A.block<3, 3>(n, n) + (yield.axial - yield.lateral) * yield.along * yield.along.transpose() +
              yield.lateral * Mat3::Identity() + N.block<3, 3>(n, n);
  const auto old = factor_.topLeftCorner(n, n);
  auto C = Z_.topLeftCorner(n, 3);
  C = A.block(0, n, n, 3) + N.block(0, n, n, 3);
  auto below = factor_.block(n, 0, 3, n);
  if (!supported_) {
    dense::solve_lower(old, 0, C);
    below = C.transpose();
    last.noalias() -= below.lazyProduct(C);
    const Eigen::LLT<Mat3> llt(last);
    if (llt.info() != Eigen::Success) return false;
    factor_.block<3, 3>(n, n) = llt.matrixL();
    return true;
  }
  // P G N, with no spring at the last: P and G N have but one column more.
  for (const int lent : lent_) {
    const int at = lent_row_[static_cast<std::size_t>(lent)];
    G_N_.block<3, 3>(at, n).noalias() = springs[static_cast<std::size_t>(lent)] * N.block<3, 3>(3 * lent, n);
    P_lent_.block<3, 3>(n, at) = A.block<3, 3>(n, 3 * lent);
  }
  const auto G_N = G_N_.topLeftCorner(lent_rows(), n + 3);
  dense::subtract_product(C, P_lent_.topLeftCorner(n, lent_rows()), G_N.rightCols<3>());
  auto R = row_.leftCols(n);
  R = A.block(n, 0, 3, n) + N.block(n, 0, 3, n);
  R.noalias() -= P_lent_.block(n, 0, 3, lent_rows()).lazyProduct(G_N.leftCols(n));
  last.noalias() -= P_lent_.block(n, 0, 3, lent_rows()).lazyProduct(G_N.rightCols<3>());
  return dense::append_lu(factor_.topLeftCorner(n + 3, n + 3), C, R, last, pivots_);
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
  const int at = lent_row_[static_cast<std::size_t>(d.grip)];
  if (at >= 0) {
    for (int k = 0; k < 3; ++k) value -= d.e[k] * G_N_.row(at + k).head(y.size()).dot(y);
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

/// Makes room: forgets the directions in which D is again what it was. @return their number
int GripMatrix::forget_unchanged(std::span<const Yield> yields) {
  int kept = 0;
  for (int k = 0; k < count_; ++k) {
    const Direction& d = directions_[static_cast<std::size_t>(k)];
    const auto g = static_cast<std::size_t>(d.grip);
    auto& known = known_[g];
    const int which = known[0] == k ? 0 : known[1] == k ? 1 : 2;
    if (!differs(component(yields[g], which), component(yields_[g], which))) {
      known[which] = -1;
      continue;
    }
    known[which] = kept;
    directions_[static_cast<std::size_t>(kept)] = d;
    Z_.col(kept) = Z_.col(k);
    F_Z_.row(kept) = F_Z_.row(k);
    F_Z_.col(kept) = F_Z_.col(k);
    ++kept;
  }
  const int forgotten = count_ - kept;
  count_ = kept;
  F_Z_.conservativeResize(count_, count_);
  return forgotten;
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
  if (needed > kMostChanges) {
    needed -= forget_unchanged(yields);
    if (needed > kMostChanges) return false;
  }
  changed_ = false;
  for (int k = 0; k < count_; ++k) directions_[static_cast<std::size_t>(k)].change = 0.0;
  for (int g = 0; g < grips_; ++g) {
    const Yield& now = yields[static_cast<std::size_t>(g)];
    const Yield& then = yields_[static_cast<std::size_t>(g)];
    for (int which = 0; which < 3; ++which) {
      const double value = component(now, which);
      const double before = component(then, which);
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
  forget_changes();
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

void GripMatrix::take_changes_in(Eigen::Ref<MatX> Y, const Eigen::Ref<const MatX>& lent) const {
  if (!changed_) return;
  // (B₀ + E Δ Fᵀ) X = C₀ − E Δ Eᵀ lent:  X = X₀ − Z (I + Δ Fᵀ Z)⁻¹ Δ (Fᵀ X₀ + Eᵀ lent),  X₀ = B₀⁻¹ C₀,  Z = B₀⁻¹ E
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
      right[i] = 0.0;
      if (d.change == 0.0) continue;
      right[i] = d.change * across(d, Y.col(c));
      if (lent.size() > 0 && lent_row_[static_cast<std::size_t>(d.grip)] >= 0)
        right[i] += d.change * d.e.dot(lent.col(c).segment<3>(3 * d.grip));
    }
    const SmallVector amount = lu.solve(right);
    for (int i = 0; i < count_; ++i) Y.col(c) -= amount[i] * Z_.col(i).head(Y.rows());
  }
}

}  // namespace stylet
