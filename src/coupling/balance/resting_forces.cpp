// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_forces.hpp"

#include <algorithm>

namespace stylet {

RestingForces::RestingForces(int grips, int most_own)
    : force_(VecX::Zero(RestingMatrix::most_rows(grips))),
      own_(VecX::Zero(3 * static_cast<Eigen::Index>(most_own))),
      change_(own_),
      moved_(MatX::Zero(own_.size(), 3)),
      solved_(MatX::Zero(force_.size(), 2)),
      along_(MatX::Zero(grips, 4)),
      mm_(static_cast<std::size_t>(grips), 0.0),
      axial_(grips, most_own),
      motion_(own_),
      z_(force_),
      now_(force_) {
  slid_.reserve(static_cast<std::size_t>(grips));
}

// NOLINTBEGIN(performance-unnecessary-value-param): views

void RestingForces::take(bool columns, const Contacts& all, std::span<const Mat3> frames, RestingGrips& grips,
                         const Eigen::Ref<const VecX>& own) {
  known_ = true;
  const RestingMatrix& matrix = grips.matrix();
  HeldTissue& held = grips.held();
  auto force = force_.head(matrix.contact_rows());
  for (int grip = 0; grip < matrix.count(); ++grip) force.segment<3>(3 * grip) = all.force(grip + 1);
  axial_.take(frames, force);
  if (columns) axial_.take_columns(grips, solved_.topRows(matrix.rows()));
  for (Eigen::Index j = 0; j < grips.sliding().count(); ++j) axial_.know(grips.sliding().grip(j), grips);
  own_.head(own.size()) = own;
  for (const int grip : slid_) mm_[static_cast<std::size_t>(grip)] = 0.0;
  slid_.clear();
  creep_ = usual_ = 0.0;
  auto moved = moved_.topRows(held.others());
  held.displacement(force, moved.col(0));
  moved.topLeftCorner<3, 1>().setZero();
  moved.col(0).noalias() += held.reduction().lazyProduct(own);
  held.motion(solved_.col(0).head(matrix.rows()), matrix, grips.sliding(), moved.col(1));
  moved.col(2).setZero();
  const Eigen::Index s = grips.sliding().count();
  along_.col(2).head(s).setZero();
  if (s > 0) grips.sliding().take(solved_.topRows(matrix.rows()), matrix, along_.topLeftCorner(s, 2));
}

void RestingForces::slide(int grip, double mm, RestingGrips& grips) {
  SlidingRows& sliding = grips.sliding();
  const RestingMatrix& matrix = grips.matrix();
  axial_.know(grip, grips);
  double& sum = mm_[static_cast<std::size_t>(grip)];
  if (std::find(slid_.begin(), slid_.end(), grip) == slid_.end()) slid_.push_back(grip);
  sum += mm;
  const HeldTissue& held = grips.held();
  const auto W = held.solved(0, matrix.rows());
  for (Eigen::Index k = 0; k < held.others(); ++k) moved_(k, 2) += mm * sliding.along(W.col(k), grip, matrix);
  for (Eigen::Index j = 0; j < sliding.count(); ++j)
    along_(j, 2) += mm * sliding.along(sliding.column(grip, matrix), sliding.grip(j), matrix);
}

void RestingForces::begin(const RestingGrips& grips) {
  const HeldTissue& held = grips.held();
  const Eigen::Index own = held.others();
  auto motion = motion_.head(own);
  motion = moved_.col(0).head(own) + creep_ * moved_.col(1).head(own) - moved_.col(2).head(own);
  if (const Eigen::Index s = grips.sliding().count(); s > 0)
    motion.noalias() += held.slipped(s).transpose().lazyProduct(along_.col(2).head(s));
}

Eigen::Ref<const VecX> RestingForces::follow(const Eigen::Ref<const VecX>& own, RestingGrips& grips) {
  const HeldTissue& held = grips.held();
  const RestingMatrix& matrix = grips.matrix();
  auto change = change_.head(own.size());
  change = own - own_.head(own.size());
  const Eigen::Index s = grips.sliding().count();
  if (s > 0) {
    auto q = along_.col(3).head(s);
    q = -creep_ * along_.col(0).head(s) + usual_ * along_.col(1).head(s) + along_.col(2).head(s);
    q.noalias() += held.of_sliding(s).lazyProduct(change);
    grips.sliding().divide(along_.block(0, 3, s, 1));
  }
  if (matrix.spring_rows() > 0) add_rows(matrix.contact_rows(), matrix.spring_rows(), grips);
  auto along = now_.head(matrix.count());
  along = axial_.reference() + creep_ * axial_.others().col(0) - usual_ * axial_.others().col(1);
  dense::subtract_product(along, axial_.own(own.size()), change);
  for (const int grip : slid_) along -= mm_[static_cast<std::size_t>(grip)] * axial_.slid(grip);
  for (Eigen::Index j = 0; j < s; ++j) along += along_(j, 3) * axial_.slid(grips.sliding().grip(j));
  return along;
}

/// Computes rows of z in z_.
void RestingForces::add_rows(Eigen::Index from, Eigen::Index count, RestingGrips& grips) {
  const RestingMatrix& matrix = grips.matrix();
  const SlidingRows& sliding = grips.sliding();
  auto z = z_.segment(from, count);
  z = creep_ * solved_.col(0).segment(from, count) - usual_ * solved_.col(1).segment(from, count);
  dense::subtract_product(z, grips.held().solved(from, count), change_.head(grips.held().others()));
  for (const int grip : slid_)
    z -= mm_[static_cast<std::size_t>(grip)] * sliding.column(grip, matrix).segment(from, count);
  for (Eigen::Index j = 0; j < sliding.count(); ++j)
    z += along_(j, 3) * sliding.column(sliding.grip(j), matrix).segment(from, count);
}

void RestingForces::compute(int first, int end, RestingGrips& grips) {
  add_rows(3 * static_cast<Eigen::Index>(first), 3 * static_cast<Eigen::Index>(end - first), grips);
}

Eigen::Ref<const VecX> RestingForces::computed(const RestingGrips& grips) {
  const RestingMatrix& matrix = grips.matrix();
  auto now = now_.head(matrix.contact_rows());
  matrix.forces(z_.head(matrix.rows()), now);
  now += force_.head(matrix.contact_rows());
  return now;
}

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet
