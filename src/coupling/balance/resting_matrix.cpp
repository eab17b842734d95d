// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// A change of D across the needle below this part of the contact's compliance is ignored; it adds to the error of the
/// next iteration. Raised, B is made anew less often, and iterations converge more slowly.
constexpr double kSameAcross = 1e-3;
/// D that B may have along a needle that has turned since, relative to the contact's compliance. Raised, B is made anew
/// less often, and iterations converge more slowly.
constexpr double kWronglyAlong = 0.1;
}  // namespace

RestingMatrix::RestingMatrix(int grips)
    : grips_(grips), contacts_(static_cast<std::size_t>(grips)), yields_(static_cast<std::size_t>(grips)) {}

bool RestingMatrix::factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                              std::span<const LentSpring> springs, std::span<const Yield> yields) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    const Mat3 own = A.block<3, 3>(row, row) + N.block<3, 3>(row, row);
    AtRest& contact = contacts_[i];
    contact.compliance = own.trace() / 3.0;
    contact.yield = yields[i];
    if (contact.yield.axial > contact.compliance) contact.yield.axial = 0.0;
    contact.frame = frame_along(contact.yield.along);
    contact.own = (contact.frame.transpose() * own * contact.frame).diagonal();
    for (int k = 0; k < 3; ++k) contact.own[k] += contact.yield.component(k);
    yields_[i] = contact.yield;
  }
  fits_ = grips_.factorise(A, N, springs, yields_) && grips_.change(yields_);
  return fits_;
}

bool RestingMatrix::is_too_different(int grip, const Yield& now) const {
  const AtRest& contact = at(grip);
  const double turned = (now.along - contact.yield.along).squaredNorm();
  const double along = std::abs(now.axial - now.lateral) * turned;
  return along > kWronglyAlong * (contact.compliance + std::min(now.axial, now.lateral)) ||
         std::abs(now.lateral - contact.yield.lateral) > kSameAcross * (contact.compliance + contact.yield.lateral);
}

bool RestingMatrix::is_negligible(const Eigen::Ref<const VecX>& z, double force_N) const {
  for (int g = 0; g < count(); ++g) {
    const Vec3 off = (at(g).frame.transpose() * z.segment<3>(3 * g)).cwiseAbs();
    if (!(off.array() <= force_N * at(g).own.array()).all()) return false;
  }
  return true;
}

}  // namespace stylet
