// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_memory.hpp"

#include "core/dense_kernels.hpp"

namespace stylet {

namespace {
constexpr double kRelaxed_mm = 1e-6;
}

TissueMemory::TissueMemory(const Creep& creep, int points)
    : creep_(creep), remembered_(MatX::Zero(3, points)), of_shaft_(remembered_) {}

void TissueMemory::begin(double h) {
  if (on()) kept_ = creep_.time_s / (h + creep_.time_s);
}

void TissueMemory::gather(const ContactCompliance& compliance) {
  if (!on() || (gathered_ == Gathered::all && version_ == compliance.version())) return;
  const Eigen::Index count = 3 * Eigen::Index{compliance.points()};
  Eigen::Map<VecX> sum(of_shaft_.data(), count);
  sum.setZero();
  const Eigen::Map<const VecX> remembered(remembered_.data() + 3, count - 3);
  dense::subtract_symmetric_product(sum.tail(count - 3), compliance.wide().block(3, 3, count - 3, count - 3),
                                    remembered);
  sum = -sum;
  sum.head<3>() = compliance.wide().block(3, 0, count - 3, 3).transpose().lazyProduct(remembered);
  gathered_ = Gathered::all;
  version_ = compliance.version();
}

void TissueMemory::gather(const ContactCompliance& compliance, std::span<const int> points, std::span<const int> by) {
  if (!on()) return;
  for (const int point : points) {
    const auto columns = compliance.wide().middleCols<3>(3 * Eigen::Index{point});  // or rows: F is symmetric
    Vec3 sum = Vec3::Zero();
    for (const int other : by)
      sum.noalias() += columns.middleRows<3>(3 * Eigen::Index{other}).transpose() * remembered_.col(other);
    of_shaft_.col(point) = sum;
  }
  gathered_ = Gathered::some;
  by_ = by;
  version_ = compliance.version();
}

Vec3 TissueMemory::displacement(const ContactCompliance& compliance, int point) const {
  if (!on()) return Vec3::Zero();
  constexpr int tip = ContactCompliance::kTip;
  if (point != tip && gathered_ != Gathered::none && version_ == compliance.version())
    return most() * kept_ * (of_shaft_.col(point) + compliance.wide(point, tip) * remembered_.col(tip));
  const Eigen::Index count = 3 * Eigen::Index{compliance.points()};
  const auto columns = compliance.wide().block(0, 3 * point, count, 3);  // or rows: F is symmetric
  if (gathered_ == Gathered::some) {
    Vec3 sum = columns.middleRows<3>(3 * tip).transpose() * remembered_.col(tip);
    for (const int other : by_)
      sum.noalias() += columns.middleRows<3>(3 * Eigen::Index{other}).transpose() * remembered_.col(other);
    return most() * kept_ * sum;
  }
  const Eigen::Map<const VecX> remembered(remembered_.data(), count);
  return most() * kept_ * columns.transpose().lazyProduct(remembered);
}

void TissueMemory::end(const Eigen::Ref<const MatX>& forces) {
  if (!on()) return;
  gathered_ = Gathered::none;
  remembered_ *= kept_;
  remembered_.leftCols(forces.cols()) += (1.0 - kept_) * forces;
  kept_ = 1.0;
}

void TissueMemory::hand_over(int from, int to, double part) {
  gathered_ = Gathered::none;
  const Vec3 moved = part * remembered_.col(from);
  remembered_.col(from) -= moved;
  remembered_.col(to) += moved;
}

bool TissueMemory::relaxed(const ContactCompliance& compliance) const {
  for (int c = 0; c < compliance.points(); ++c) {
    if (displacement(compliance, c).squaredNorm() > kRelaxed_mm * kRelaxed_mm) return false;
  }
  return true;
}

void TissueMemory::reset() {
  gathered_ = Gathered::none;
  remembered_.setZero();
}

}  // namespace stylet
