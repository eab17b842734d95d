// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/paper/condensed_system.hpp"

#include <array>

namespace stylet::paper {

CondensedSystem::CondensedSystem(int capacity) {
  const Eigen::Index size = 3 * capacity;
  K_ = MatX::Zero(size, size);
  softness_ = VecX::Zero(size);
  displacement_.assign(static_cast<std::size_t>(size), 0);
  left_.resize(static_cast<std::size_t>(size));
  right_.resize(static_cast<std::size_t>(size));
  held_ = MatX::Zero(size, 3);
}

void CondensedSystem::switch_row(int row) {
  const auto size = static_cast<std::size_t>(3 * points_);
  switch_axis<double>(K_.topLeftCorner(3 * points_, 3 * points_), row, {left_.data(), size}, {right_.data(), size});
  displacement_[static_cast<std::size_t>(row)] ^= 1;
  ++switches_;
}

void CondensedSystem::control_displacement(int row, bool displacement) {
  if (is_displacement(row) != displacement) switch_row(row);
}

template <class Change>
void CondensedSystem::under_force_control(int point, Change&& change) {
  std::array<bool, 3> kinds{};
  for (int k = 0; k < 3; ++k) {
    kinds[static_cast<std::size_t>(k)] = is_displacement(3 * point + k);
    control_displacement(3 * point + k, false);
  }
  change();
  for (int k = 0; k < 3; ++k) control_displacement(3 * point + k, kinds[static_cast<std::size_t>(k)]);
}

int CondensedSystem::add(const Eigen::Ref<const MatX>& across, const Mat3& own) {
  const int size = 3 * points_;
  auto held = held_.topRows(size);
  for (int i = 0; i < size; ++i) {
    if (is_displacement(i)) {
      held.row(i) = across.row(i);
    } else {
      held.row(i).setZero();
    }
  }
  auto column = K_.block(0, size, size, 3);
  column.noalias() = -K_.topLeftCorner(size, size).lazyProduct(held);
  Mat3 left = own;  // Schur complement of the displacement-controlled rows
  for (int i = 0; i < size; ++i) {
    if (is_displacement(i)) {
      left.noalias() += held.row(i).transpose() * column.row(i);
    } else {
      column.row(i) += across.row(i);
    }
  }
  for (int i = 0; i < size; ++i) {
    const double sign = is_displacement(i) ? -1.0 : 1.0;
    for (int k = 0; k < 3; ++k) K_(size + k, i) = sign * column(i, k);
  }
  K_.block<3, 3>(size, size) = left;
  for (int k = 0; k < 3; ++k) {
    softness_[size + k] = 0.0;
    displacement_[static_cast<std::size_t>(size + k)] = 0;
  }
  return points_++;
}

void CondensedSystem::remove(int point) {
  for (int k = 0; k < 3; ++k) control_displacement(3 * point + k, false);
  const int last = points_ - 1;
  if (point != last) {
    const int size = 3 * points_;
    for (int k = 0; k < 3; ++k) {
      const int from = 3 * last + k;
      const int to = 3 * point + k;
      K_.col(to).head(size) = K_.col(from).head(size);
      K_.row(to).head(size) = K_.row(from).head(size);
      K_(to, to) = K_(from, from);
      softness_[to] = softness_[from];
      displacement_[static_cast<std::size_t>(to)] = displacement_[static_cast<std::size_t>(from)];
    }
    // For the point's own three rows the two copies above mix old and new values.
    K_.block<3, 3>(3 * point, 3 * point) = K_.block<3, 3>(3 * last, 3 * last);
  }
  --points_;
}

void CondensedSystem::rotate(int point, const Mat3& S) {
  under_force_control(point, [&] {
    const int size = 3 * points_;
    const Vec3 softness = softness_.segment<3>(3 * point);
    K_.diagonal().segment<3>(3 * point) -= softness;
    for (int j = 0; j < size; ++j) K_.block<3, 1>(3 * point, j) = (S * K_.block<3, 1>(3 * point, j)).eval();
    for (int i = 0; i < size; ++i) K_.block<1, 3>(i, 3 * point) = (K_.block<1, 3>(i, 3 * point) * S.transpose()).eval();
    K_.diagonal().segment<3>(3 * point) += softness;
  });
}

void CondensedSystem::set_softness(int row, double softness) {
  const double change = softness - softness_[row];
  if (change == 0.0) return;
  const bool displacement = is_displacement(row);
  control_displacement(row, false);
  K_(row, row) += change;
  softness_[row] = softness;
  control_displacement(row, displacement);
}

}  // namespace stylet::paper
