// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_memory.hpp"

namespace stylet {

namespace {
constexpr double kRelaxed_mm = 1e-6;
}

TissueMemory::TissueMemory(const Creep& creep, int points) : creep_(creep), remembered_(MatX::Zero(3, points)) {}

void TissueMemory::begin(double h) {
  if (on()) kept_ = creep_.time_s / (h + creep_.time_s);
}

Vec3 TissueMemory::displacement(const ContactCompliance& compliance, int point) const {
  Vec3 u = Vec3::Zero();
  if (!on()) return u;
  const auto columns = compliance.wide().middleCols<3>(3 * point);  // or rows: F is symmetric
  for (int d = 0; d < compliance.points(); ++d) {
    if (!remembered_.col(d).isZero(0.0)) u.noalias() += columns.middleRows<3>(3 * d).transpose() * past(d);
  }
  return u;
}

void TissueMemory::end(const Eigen::Ref<const MatX>& forces) {
  if (!on()) return;
  remembered_ *= kept_;
  remembered_.leftCols(forces.cols()) += (1.0 - kept_) * forces;
  kept_ = 1.0;
}

void TissueMemory::hand_over(int from, int to, double part) {
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

void TissueMemory::reset() { remembered_.setZero(); }

}  // namespace stylet
