// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/tip_drift.hpp"

namespace stylet {

namespace {
/// [mm] From a shorter cut no derivative is computed.
constexpr double kShortestCut_mm = 1e-5;
/// [mm] Tolerance of E. Raised, fewer sub-steps balance the moved needle twice.
constexpr double kSameDrift_mm = 5e-5;

/// [mm] How far the force on the tip moves a contact at rest.
Vec3 by_tip(const Contacts& all, const TipRelief& relief, int contact) {
  const int point = all.point(contact);
  return all.tissue.own_compliance_now(point, ContactCompliance::kTip) * all.tip.force - relief.of(point);
}
}  // namespace

TipDrift::TipDrift(Eigen::Index rows)
    : moves_(VecX::Zero(rows)),
      columns_(MatX::Zero(rows, 3)),
      usual_(moves_),
      at_rest_(MatX::Zero(rows, 2)),
      now_(moves_) {}

void TipDrift::forget() {
  usual_.setZero();
  at_rest_.setZero();
}

Eigen::Ref<const VecX> TipDrift::remember(const Contacts& all, const RestingMatrix& matrix) {
  write(all, matrix, usual_.head(matrix.rows()));
  return usual_.head(matrix.rows());
}

void TipDrift::look(const Contacts& all, const RestingMatrix& matrix) {
  const TipRelief relief = all.tissue.relief(all.forces());
  tip_force_ = all.tip.force;
  as_usual_ = 0.0;
  for (int c = 1; c < all.first_own(); ++c) {
    moves_.segment<3>(3 * c - 3) = by_tip(all, relief, c);
    Mat3 column = all.tissue.own_compliance_now(all.point(c), ContactCompliance::kTip);
    if (relief.is_any()) column -= relief.slope(all.point(c));
    columns_.middleRows<3>(3 * c - 3) = column;
  }
  at_rest_.col(0).head(matrix.rows()).setZero();
}

/// Writes E at the present place of the tip.
void TipDrift::write(const Contacts& all, const RestingMatrix& matrix, Eigen::Ref<VecX> E) const {
  const TipRelief relief = all.tissue.relief(all.forces());
  const Vec3 more = all.tip.force - tip_force_;
  for (int c = 1; c < all.first_own(); ++c)
    E.segment<3>(3 * c - 3) =
        by_tip(all, relief, c) - moves_.segment<3>(3 * c - 3) - columns_.middleRows<3>(3 * c - 3) * more;
  matrix.fill_springs(E);
}

double TipDrift::begin(const Contacts& all, const RestingMatrix& matrix) {
  auto E = at_rest_.col(0).head(matrix.rows());
  write(all, matrix, E);
  const auto usual = usual_.head(matrix.rows());
  const double square = usual.squaredNorm();
  if (square == 0.0) return 0.0;
  const double like = E.dot(usual) / square;
  E -= like * usual;
  return like - std::exchange(as_usual_, like);
}

bool TipDrift::fits(const Contacts& all, const RestingMatrix& matrix) {
  const Eigen::Index rows = matrix.rows();
  const double cut = all.tip.touches() ? all.tip.cut.advance() : 0.0;
  if (cut < kShortestCut_mm) return true;
  auto more = now_.head(rows);
  write(all, matrix, more);
  more -= as_usual_ * usual_.head(rows) + at_rest_.col(0).head(rows);
  auto slope = at_rest_.col(1).head(rows);
  const double off = (more - cut * slope).lpNorm<Eigen::Infinity>();
  slope = more / cut;
  return off < kSameDrift_mm;
}

}  // namespace stylet
