// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_memory.hpp"

#include <Eigen/Cholesky>

namespace stylet {

namespace {
constexpr double kRelaxed_mm = 1e-6;
}

TissueMemory::TissueMemory(double relaxation_s, int points)
    : relaxation_s_(relaxation_s), past_(MatX::Zero(3, points)) {}

void TissueMemory::begin(double h) {
  if (!on()) return;
  share_ = h / (h + relaxation_s_);
  past_ *= 1.0 - share_;
}

Vec3 TissueMemory::displacement(const ContactCompliance& compliance, int point) const {
  Vec3 u = Vec3::Zero();
  if (!on()) return u;
  const auto row = compliance.matrix().middleRows<3>(3 * point);
  for (int d = 0; d < compliance.points(); ++d) {
    if (!past_.col(d).isZero(0.0)) u.noalias() += row.middleCols<3>(3 * d) * past_.col(d);
  }
  return u;
}

void TissueMemory::end(const Eigen::Ref<const MatX>& forces) {
  if (!on()) return;
  past_.leftCols(forces.cols()) += share_ * forces;
  share_ = 0.0;
}

void TissueMemory::hand_over(int from, int to, double part) {
  const Vec3 moved = part * past_.col(from);
  past_.col(from) -= moved;
  past_.col(to) += moved;
}

void TissueMemory::keep_displacement(const ContactCompliance& compliance, int point, const Vec3& u) {
  if (!on()) return;
  const Eigen::LDLT<Mat3> own(compliance(point, point));
  if (own.isPositive() && own.vectorD().minCoeff() > 0.0)
    past_.col(point) += own.solve(u - displacement(compliance, point));
}

bool TissueMemory::relaxed(const ContactCompliance& compliance) const {
  for (int c = 0; c < compliance.points(); ++c) {
    if (displacement(compliance, c).squaredNorm() > kRelaxed_mm * kRelaxed_mm) return false;
  }
  return true;
}

void TissueMemory::reset() { past_.setZero(); }

}  // namespace stylet
