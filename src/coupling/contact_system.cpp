// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_system.hpp"

#include "core/dense_kernels.hpp"

#include <Eigen/LU>

#include <utility>

namespace stylet {

ContactSystem::ContactSystem(int contacts) : grips_(contacts - 1), prepared_grips_(contacts - 1) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(contacts);
  const Eigen::Index most_springs = 2 * static_cast<Eigen::Index>(contacts);
  A = N = prepared.N = MatX::Zero(dense::column_length(n), n);
  free = now = gap = shift = drift = lambda = push = work_ = VecX::Zero(n);
  frame.assign(static_cast<std::size_t>(contacts), Mat3::Identity());
  yield.assign(static_cast<std::size_t>(contacts), Yield{});
  spring.assign(static_cast<std::size_t>(contacts), LentSpring{});
  prepared.spring = spring;
  beyond_ = MatX::Zero(dense::column_length(n), 3);
  column_ = begun_ = MatX::Zero(n + most_springs, kRight);
  solved_ = MatX::Zero(n + most_springs, kDrift + 1);
}

bool ContactSystem::factorise() {
  lacks_tip_ = true;
  const Eigen::Index n = grip_rows();
  if (n == 0) return true;
  return grips_.factorise(A.block(3, 3, n, n), N.block(3, 3, n, n), grip_springs(), grip_yields());
}

bool ContactSystem::append() {
  lacks_tip_ = true;
  if (grip_count() == 1) return factorise();
  const Eigen::Index n = grip_rows();
  return grips_.append(A.block(3, 3, n, n), N.block(3, 3, n, n), grip_yields().back());
}

bool ContactSystem::keep_first(int contacts) {
  lacks_tip_ = true;
  count = contacts;
  return grips_.keep_first(contacts - 1);
}

void ContactSystem::fill_prepared() {
  const auto grips = static_cast<std::size_t>(prepared.count - 1);
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(grips);
  const auto springs = prepared.supported ? std::span<const LentSpring>(prepared.spring).subspan(1, grips)
                                          : std::span<const LentSpring>();
  prepared_grips_.fill(A.block(3, 3, n, n), prepared.N.block(3, 3, n, n), springs,
                       std::span<const Yield>(yield).subspan(1, grips));
}

bool ContactSystem::factorise_prepared() { return prepared_grips_.factorise_filled(); }

void ContactSystem::take_prepared() {
  lacks_tip_ = true;
  count = prepared.count;
  N.swap(prepared.N);
  spring.swap(prepared.spring);
  supported = prepared.supported;
  std::swap(grips_, prepared_grips_);
}

void ContactSystem::add_tip() {
  lacks_tip_ = false;
  solved_for_ = 0;
  const Eigen::Index n = grip_rows();
  if (n == 0) return;
  // Of a push at the tip, and of a force of its spring, which is the tissue's alone.
  auto column = column_.topRows(grips_.rows());
  for (int k = 0; k < 3; ++k) {
    auto of_spring = column.col(k);
    of_spring.head(n) = A.block(3, k, n, 1);
    grips_.across(of_spring.head(n), of_spring.tail(grips_.spring_rows()));
  }
  column.rightCols<3>() = column.leftCols<3>();
  column.rightCols<3>().topRows(n) += N.block(3, 0, n, 3);
  begun_.topRows(grips_.rows()) = column;
  grips_.begin(begun_.block(0, kTip, grips_.rows(), 3));
  if (lends_at_tip()) grips_.begin(begun_.block(0, kSpring, grips_.rows(), 3));
}

Vec3 ContactSystem::error(int contact) const {
  const auto c = static_cast<std::size_t>(contact);
  const Vec3 off = gap.segment<3>(3 * contact) + yield[c].of(now.segment<3>(3 * contact));
  return frame[c].transpose() * off - shift.segment<3>(3 * contact);
}

Vec3 ContactSystem::own_yield(int contact) const {
  const auto c = static_cast<std::size_t>(contact);
  const Mat3& Q = frame[c];
  const Mat3 own = A.block<3, 3>(3 * contact, 3 * contact) + N.block<3, 3>(3 * contact, 3 * contact);
  Vec3 result;
  for (int k = 0; k < 3; ++k) {
    const Vec3 q = Q.col(k);
    const double along = q.dot(yield[c].along);
    result[k] = q.dot(own * q) + yield[c].lateral + (yield[c].axial - yield[c].lateral) * along * along;
  }
  return result;
}

/// The grips and springs by themselves: B⁻¹ of the tip's columns, of the right-hand side and of the drift.
bool ContactSystem::solve_grips() {
  const Eigen::Index n = grip_rows();
  if (n > 0 && !grips_.change(grip_yields()) && !(factorise() && grips_.change(grip_yields()))) return false;
  if (lacks_tip_) add_tip();
  if (n == 0) return true;

  const Eigen::Index all = grips_.rows();
  auto right = solved_.col(kRight).head(all);
  for (int c = 1; c < count; ++c) right.segment<3>(3 * c - 3).noalias() = frame[static_cast<std::size_t>(c)] * error(c);
  grips_.across(right.head(n), right.tail(grips_.spring_rows()));
  right = -right;
  right.head(n) += free.segment(3, n);
  if (drifts()) {
    auto drifting = solved_.col(kDrift).head(all);
    drifting.head(n) = drift.segment(3, n);
    grips_.across(drifting.head(n), drifting.tail(grips_.spring_rows()));
  }
  const Eigen::Index rights = drifts() ? 2 : 1;
  grips_.begin(solved_.block(0, kRight, all, rights));
  const bool anew = solved_for_ != grips_.version();
  if (anew) solved_.block(0, kTip, all, 3) = begun_.block(0, kTip, all, 3);
  const Eigen::Index from = anew ? kTip : kRight;
  grips_.finish(solved_.block(0, from, all, kRight + rights - from));
  if (anew && lends_at_tip()) {
    solved_.block(0, kSpring, all, 3) = begun_.block(0, kSpring, all, 3);
    grips_.finish(solved_.block(0, kSpring, all, 3));
  }
  solved_for_ = grips_.version();
  if (drifts()) right -= cut_due * solved_.col(kDrift).head(all);
  return true;
}

/// The tip: its three rows with the others taken out.
/// @return π of the tip, and the force φ of the spring there
std::pair<Vec3, Vec3> ContactSystem::solve_tip(TipRows held) {
  const Eigen::Index n = grip_rows();
  const Eigen::Index all = n > 0 ? grips_.rows() : 0;
  const auto column = column_.block(0, kTip, all, 3);
  const auto solved = solved_.block(0, kTip, all, 3);
  const auto of_spring = solved_.block(0, kSpring, all, 3);
  const auto right = solved_.col(kRight).head(all);
  const auto drifting = solved_.col(kDrift).head(all);
  const Mat3& Q = frame.front();
  const Vec3 t = Q.col(2);
  const Mat3 N_tip = N.topLeftCorner<3, 3>();

  // What π and φ push the tissue by, and where the tip is off.
  const Yield& tip = yield.front();
  Mat3 own = A.topLeftCorner<3, 3>();
  own += (tip.axial - tip.lateral) * tip.along * tip.along.transpose() + tip.lateral * Mat3::Identity();
  Mat3 corner = N_tip;
  Vec3 rest = free.head<3>() - Q * error(0);
  if (drifts()) {
    own.noalias() += cut_per_N * drift.head<3>() * t.transpose();
    rest -= cut_due * drift.head<3>();
  }
  if (n > 0) {
    corner.noalias() -= column.transpose().lazyProduct(solved);
    rest.noalias() -= column.transpose().lazyProduct(right);
    if (drifts()) {
      const Vec3 by_grips = column.transpose().lazyProduct(drifting);
      own.noalias() -= cut_per_N * by_grips * t.transpose();
    }
  }
  corner += own;

  Along lent;  // φ
  if (lends_at_tip()) {
    const Mat3 G = spring.front().matrix();
    Along moves = {free.head<3>(), N_tip};
    Mat3 borne = Mat3::Identity();
    if (n > 0) {
      const Mat3 per_lent = subtract_grips(N.block(3, 0, n, 3), moves);
      own.noalias() -= column.transpose().lazyProduct(of_spring);
      borne.noalias() += G * per_lent;
    }
    const Eigen::PartialPivLU<Mat3> carried(borne);
    lent = {carried.solve(G * moves.at), carried.solve(G * moves.per)};
    corner.noalias() -= own * lent.per;
    rest.noalias() -= own * lent.at;
  }

  // Rows that are not held carry nothing any more: λ = 0.
  Mat3 left = Q.transpose() * corner * Q;
  Vec3 given = Q.transpose() * rest;
  const Mat3 free_row = Q.transpose() * (Mat3::Identity() - lent.per) * Q;
  const Vec3 carried = Q.transpose() * (now.head<3>() + lent.at);
  const int held_from = held == TipRows::all ? 0 : held == TipRows::axial ? 2 : 3;
  for (int k = 0; k < held_from; ++k) {
    left.row(k) = free_row.row(k);
    given[k] = -carried[k];
  }
  if (turns(held)) {
    // The force turns with the direction, and more or less of how far the tip is aside is along it.
    const Eigen::Index g = 3 * static_cast<Eigen::Index>(behind);
    Along turn = {free.head<3>() - free.segment<3>(g), N_tip - N.block<3, 3>(g, 0)};
    beyond_.topRows(n) = N.block(3, 0, n, 3) - N.block(3, g, n, 3);
    const Mat3 per_lent = subtract_grips(beyond_.topRows(n), turn);
    turn.at -= per_lent * lent.at;
    turn.per -= per_lent * lent.per;
    const double pressed = t.dot(now.head<3>()) / behind_mm;
    const Vec3 aside = Q.leftCols<2>() * error(0).head<2>() / behind_mm;
    left.topRows<2>() += pressed * Q.leftCols<2>().transpose() * turn.per * Q;
    given.head<2>() += pressed * Q.leftCols<2>().transpose() * turn.at;
    left.row(2) -= aside.transpose() * turn.per * Q;
    given[2] -= aside.dot(turn.at);
  }
  const Vec3 change = Q * Eigen::PartialPivLU<Mat3>(left).solve(given);
  return {change, lent.at - lent.per * change};
}

/// Takes off what of a motion at − per π_0 is due to the grips' pushes.
/// @param columns of N that give the motion of those pushes
/// @return what the motion has of the tip's spring by way of the grips: − (…) φ
Mat3 ContactSystem::subtract_grips(const Eigen::Ref<const MatX>& columns, Along& moves) const {
  const Eigen::Index n = grip_rows();
  const auto row = columns.transpose();
  moves.per -= Mat3(row.lazyProduct(solved_.block(0, kTip, n, 3)));
  moves.at -= Vec3(row.lazyProduct(solved_.col(kRight).head(n)));
  Mat3 per_lent = Mat3::Zero();
  if (lends_at_tip()) per_lent = -Mat3(row.lazyProduct(solved_.block(0, kSpring, n, 3)));
  if (drifts()) {
    const Vec3 more = row.lazyProduct(solved_.col(kDrift).head(n));
    const Mat3 per_force = cut_per_N * more * frame.front().col(2).transpose();
    moves.per -= per_force;
    per_lent -= per_force;
  }
  return per_lent;
}

bool ContactSystem::solve(TipRows held) {
  if (!solve_grips()) return false;
  const auto [change, lent] = solve_tip(held);
  push.head<3>() = now.head<3>() + change;

  const Eigen::Index n = grip_rows();
  auto forces = work_.head(rows());
  forces.head<3>() = push.head<3>() + lent;
  if (n > 0) {
    const Eigen::Index all = grips_.rows();
    auto right = solved_.col(kRight).head(all);
    right.noalias() -= solved_.block(0, kTip, all, 3).lazyProduct(change);
    if (lends_at_tip()) right.noalias() -= solved_.block(0, kSpring, all, 3).lazyProduct(lent);
    if (drifts()) right -= cut_per_N * frame.front().col(2).dot(change + lent) * solved_.col(kDrift).head(all);
    push.segment(3, n) = now.segment(3, n) + right.head(n);
    forces.tail(n) = push.segment(3, n);
    grips_.add_lent(right.tail(grips_.spring_rows()), forces.tail(n));
  }
  for (int c = 0; c < count; ++c)
    lambda.segment<3>(3 * c).noalias() = frame[static_cast<std::size_t>(c)].transpose() * forces.segment<3>(3 * c);
  if (held == TipRows::none) lambda.head<3>().setZero();
  if (held == TipRows::axial && !turns(held)) lambda.head<2>().setZero();
  return push.head(rows()).allFinite();
}

double ContactSystem::axial_excess(int contact) const {
  const auto c = static_cast<std::size_t>(contact);
  const Vec3 change = frame[c] * lambda.segment<3>(3 * contact) - now.segment<3>(3 * contact);
  return frame[c].col(2).dot(grips_.yield(contact - 1).of(change) - yield[c].of(change));
}

double ContactSystem::opening() const {
  const Vec3 t = frame.front().col(2);
  Vec3 way = free.head<3>() - gap.head<3>();
  for (int c = 0; c < count; ++c) {
    const Vec3 force = frame[static_cast<std::size_t>(c)] * lambda.segment<3>(3 * c);
    way -= N.block<3, 3>(0, 3 * c) * (push.segment<3>(3 * c) - now.segment<3>(3 * c));
    way -= A.block<3, 3>(0, 3 * c) * (force - now.segment<3>(3 * c));
  }
  return t.dot(way);
}

}  // namespace stylet
