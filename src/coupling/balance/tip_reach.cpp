// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/tip_reach.hpp"

namespace stylet {

namespace {
/// [mm] From a shorter cut no derivative is computed.
constexpr double kShortestCut_mm = 1e-3;
/// [mm] A derivative is not used where the tip has moved further since it was computed.
constexpr double kSamePlace_mm = 2.0;
}  // namespace

TipReach::TipReach(int grips, int most_own)
    : columns_(MatX::Zero(RestingMatrix::most_rows(grips), kCount)),
      seen_(static_cast<std::size_t>(grips), 0.0),
      of_own_(MatX::Zero(3 * static_cast<Eigen::Index>(most_own), kCount)),
      of_sliding_(MatX::Zero(grips, kCount)),
      held_(of_own_),
      change_(MatX::Zero(columns_.rows(), kLook)),
      work_(MatX::Zero(std::max(of_own_.rows(), of_sliding_.rows()), kCount)) {}

/// Writes V of a contact at rest at the present place of the tip (3 × 6).
void TipReach::write(const Contacts& all, int grip, Eigen::Ref<MatX> V) const {
  const int point = all.point(grip + 1);
  const ContactCompliance& tissue = all.tissue.compliance();
  const double share = all.tissue.creep_share();
  constexpr Eigen::Index tip = 3 * ContactCompliance::kTip;
  const auto A = tissue.matrix().block<3, 3>(3 * point, tip);
  const auto F = tissue.wide().block<3, 3>(3 * point, tip);
  V.leftCols<3>() = A + share * F;
  V.rightCols<3>() = A - F;
}

Eigen::Ref<const VecX> TipReach::remember(const Contacts& all, const RestingMatrix& matrix) {
  const TipLaw now = TipLaw::of(all);
  const Vec6 w = look_.at(all.tip.force);
  MatX& V = change_;
  auto usual = columns_.col(kUsual).head(matrix.rows());
  for (int grip = 0; grip < matrix.count(); ++grip) {
    write(all, grip, V.topLeftCorner<3, 6>());
    usual.segment<3>(3 * grip) = V.topLeftCorner<3, 6>() * now.v - columns_.block<3, 6>(3 * grip, kLook) * w;
  }
  matrix.fill_springs(usual);
  return usual;
}

void TipReach::look(const Contacts& all, const RestingMatrix& matrix) {
  look_ = start_ = TipLaw::of(all);
  const Vec3& x = all.tip.cut.x();
  if (!((x - at_.x).norm() < kSamePlace_mm)) columns_.middleCols<6>(kSlope).setZero();
  at_ = {x, 0.0};
  taken_ = as_usual_ = 0.0;
  std::fill(seen_.begin(), seen_.end(), 0.0);
  for (int grip = 0; grip < matrix.count(); ++grip) write(all, grip, columns_.block<3, 6>(3 * grip, kNow));
  columns_.middleCols<6>(kLook) = columns_.middleCols<6>(kNow);
  for (Eigen::Index k = 0; k < kCount; ++k) matrix.fill_springs(columns_.col(k).head(matrix.rows()));
}

// NOLINTBEGIN(performance-unnecessary-value-param): a view
void TipReach::take(bool columns, const Contacts& all, RestingGrips& grips, const Eigen::Ref<const VecX>& forces) {
  taken_ = as_usual_;
  const RestingMatrix& matrix = grips.matrix();
  const auto V = columns_.topRows(matrix.rows());
  if (columns) grips.held().answers(V, of_own_.topRows(grips.held().others()));
  const Eigen::Index s = grips.sliding().count();
  if (s > 0) grips.sliding().answer(V, matrix, of_sliding_.topRows(s));
  of_forces_.noalias() = V.topRows(forces.size()).transpose().lazyProduct(forces);
  if (!all.tissue.memory().on()) return;
  of_memory_.setZero();
  for (int grip = 0; grip < matrix.count(); ++grip)
    change(grip, all.force(grip + 1), all.tissue.memory().remembered(all.point(grip + 1)));
}

void TipReach::change(int grip, const Vec3& force, const Vec3& memory) {
  const auto V = columns_.block<3, kLook>(3 * grip, 0);
  of_memory_.col(0) += V.transpose() * memory;
  of_memory_.col(1) += V.transpose() * force;
}

void TipReach::visit(const Contacts& all, int first, int end, RestingGrips& grips,
                     const Eigen::Ref<const VecX>& forces) {
  const double now_mm = cut(all);
  const RestingMatrix& matrix = grips.matrix();
  const Eigen::Index from = 3 * static_cast<Eigen::Index>(first);
  const Eigen::Index count = 3 * static_cast<Eigen::Index>(end - first);
  for (int grip = first; grip < end; ++grip) {
    Eigen::Matrix<double, 3, 6> V;
    write(all, grip, change_.block<3, 6>(3 * (grip - first), 0));
    V = change_.block<3, 6>(3 * (grip - first), 0);
    auto now = columns_.block<3, 6>(3 * grip, kNow);
    auto slope = columns_.block<3, 6>(3 * grip, kSlope);
    const Eigen::Matrix<double, 3, 6> now_before = now;
    const Eigen::Matrix<double, 3, 6> slope_before = slope;
    double& seen = seen_[static_cast<std::size_t>(grip)];
    if (now_mm - seen > kShortestCut_mm) {
      slope = (V - now - seen * slope).eval() / (now_mm - seen);
      seen = now_mm;
    }
    now = V - now_mm * slope;
    change_.block<3, 6>(3 * (grip - first), kNow) = now - now_before;
    change_.block<3, 6>(3 * (grip - first), kSlope) = slope - slope_before;
  }
  const auto change = change_.topRows(count);
  const Eigen::Index own = grips.held().others();
  grips.held().add_answers(from, change, of_own_.topLeftCorner(own, kLook), work_.topLeftCorner(own, kLook));
  grips.sliding().add_answers(from, change, matrix, of_sliding_);
  of_forces_.head<kLook>().noalias() += change.transpose().lazyProduct(forces.segment(from, count));
  for (int grip = first; all.tissue.memory().on() && grip < end; ++grip) {
    const auto dV = change_.block<3, kLook>(3 * (grip - first), 0);
    of_memory_.col(0) += dV.transpose() * all.tissue.memory().remembered(all.point(grip + 1));
    of_memory_.col(1) += dV.transpose() * all.force(grip + 1);
  }
  if (matrix.spring_rows() == 0) return;
  // The rows of springs follow from those of the contacts.
  const Eigen::Index springs = matrix.spring_rows();
  for (Eigen::Index k = 0; k < kLook; ++k) {
    auto column = columns_.col(k).head(matrix.rows());
    change_.col(k).head(springs) = -column.tail(springs);
    matrix.fill_springs(column);
    change_.col(k).head(springs) += column.tail(springs);
  }
  const auto more = change_.topRows(springs);
  const Eigen::Index at = matrix.contact_rows();
  grips.held().add_answers(at, more, of_own_.topLeftCorner(own, kLook), work_.topLeftCorner(own, kLook));
  grips.sliding().add_answers(at, more, matrix, of_sliding_);
}
// NOLINTEND(performance-unnecessary-value-param)

double TipReach::begin(const Contacts& all, RestingGrips& grips) {
  start_ = TipLaw::of(all);
  const Eigen::Index own = grips.held().others();
  auto held = held_.topRows(own);
  held = of_own_.topRows(own);
  if (const Eigen::Index s = grips.sliding().count(); s > 0)
    held.noalias() -= grips.held().slipped(s).transpose().lazyProduct(of_sliding_.topRows(s));
  const auto usual = held.col(kUsual);
  const double square = usual.squaredNorm();
  if (square == 0.0) return 0.0;
  Weights all_of_E = weights(all);
  all_of_E[kUsual] = 0.0;
  auto E = work_.col(0).head(own);
  E.noalias() = held.lazyProduct(all_of_E);
  as_usual_ = E.dot(usual) / square;
  return as_usual_ - taken_;
}

void TipReach::end(const Contacts& all, double kept) {
  at_ = {all.tip.cut.x(), cut(all)};
  of_memory_.col(0) = kept * of_memory_.col(0) + (1.0 - kept) * of_memory_.col(1);
}

/// The columns' weights in E at the present iterate.
TipReach::Weights TipReach::weights(const Contacts& all) const {
  Weights y;
  y.segment<6>(kNow) = start_.at(all.tip.force);
  y.segment<6>(kSlope) = cut(all) * y.segment<6>(kNow);
  y.segment<6>(kLook) = -look_.at(all.tip.force);
  y[kUsual] = -taken_;
  return y;
}

Vec3 TipReach::felt(const Contacts& all, Eigen::Index row) const {
  return held_.middleRows<3>(row).lazyProduct(weights(all));
}

// NOLINTBEGIN(performance-unnecessary-value-param): views
Vec3 TipReach::at_tip(const Contacts& all, const Eigen::Ref<const VecX>& own,
                      const Eigen::Ref<const VecX>& own_before) const {
  const double s = cut(all);
  Vec6 moved = Vec6::Zero();
  for (Eigen::Index row = 0; row < own.size(); ++row) {
    const auto held = held_.row(row);
    moved += (own[row] - own_before[row]) *
             (held.segment<6>(kNow) + s * held.segment<6>(kSlope) - held.segment<6>(kLook)).transpose();
  }
  return of_forces_.segment<3>(kNow) + s * of_forces_.segment<3>(kSlope) - start_.slope.transpose() * moved;
}
// NOLINTEND(performance-unnecessary-value-param)

Vec3 TipReach::remembered(const Contacts& all) const {
  const Vec6 by = of_memory_.block<6, 1>(kNow, 0) + cut(all) * of_memory_.block<6, 1>(kSlope, 0);
  return (by.head<3>() - by.tail<3>()) / (1.0 + all.tissue.creep_share());
}

Vec3 TipReach::of_others(const Contacts& all) const {
  return of_forces_.segment<3>(kNow + 3) + cut(all) * of_forces_.segment<3>(kSlope + 3);
}

}  // namespace stylet
