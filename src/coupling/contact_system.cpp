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
  column_ = begun_ = MatX::Zero(n + most_springs, 3);
  solved_ = MatX::Zero(n + most_springs, 5);
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
  auto column = column_.topRows(grips_.rows());
  for (int k = 0; k < 3; ++k) {
    column.col(k).head(n) = A.block(3, k, n, 1);
    grips_.across(column.col(k).head(n), column.col(k).tail(grips_.spring_rows()));
  }
  column.topRows(n) += N.block(3, 0, n, 3);
  auto begun = begun_.topRows(grips_.rows());
  begun = column;
  grips_.begin(begun);
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

bool ContactSystem::solve(TipRows held) {
  const Eigen::Index n = grip_rows();
  if (n > 0 && !grips_.change(grip_yields()) && !(factorise() && grips_.change(grip_yields()))) return false;
  if (lacks_tip_) add_tip();

  // The grips and springs by themselves: B⁻¹ of the tip's columns, of the right-hand side and of the drift.
  const Eigen::Index rows_there = n > 0 ? grips_.rows() : 0;
  const bool drifts = cut_per_N > 0.0;
  auto column = column_.topRows(rows_there);
  auto solved = solved_.topLeftCorner(rows_there, 3);
  auto right = solved_.col(3).head(rows_there);
  auto drifting = solved_.col(4).head(rows_there);
  if (n > 0) {
    for (int c = 1; c < count; ++c)
      right.segment<3>(3 * c - 3).noalias() = frame[static_cast<std::size_t>(c)] * error(c);
    grips_.across(right.head(n), right.tail(grips_.spring_rows()));
    right = -right;
    right.head(n) += free.segment(3, n);
    if (drifts) {
      drifting.head(n) = drift.segment(3, n);
      grips_.across(drifting.head(n), drifting.tail(grips_.spring_rows()));
    }
    const Eigen::Index rights = drifts ? 2 : 1;
    grips_.begin(solved_.block(0, 3, rows_there, rights));
    const bool all = solved_for_ != grips_.version();
    if (all) solved = begun_.topRows(rows_there);
    grips_.finish(all ? solved_.topLeftCorner(rows_there, 3 + rights) : solved_.block(0, 3, rows_there, rights));
    solved_for_ = grips_.version();
    if (drifts) right -= cut_due * drifting;
  }

  // The tip: its three rows with the others taken out.
  const Mat3& Q = frame.front();
  const Yield& tip = yield.front();
  Mat3 own = A.topLeftCorner<3, 3>();
  own += (tip.axial - tip.lateral) * tip.along * tip.along.transpose() + tip.lateral * Mat3::Identity();
  const Mat3 N_tip = N.topLeftCorner<3, 3>();
  const Mat3 lent = n == 0 && supported ? spring.front().matrix() : Mat3::Zero();
  Mat3 corner = own - own * lent * N_tip + N_tip;
  Vec3 rest = free.head<3>() - own * (lent * free.head<3>()) - Q * error(0);
  if (n > 0) {
    corner.noalias() -= column.transpose().lazyProduct(solved);
    rest.noalias() -= column.transpose().lazyProduct(right);
  }
  if (drifts) {
    const Vec3 t = Q.col(2);
    Vec3 own_drift = drift.head<3>();
    rest -= (cut_due + cut_per_N * t.dot(lent * free.head<3>())) * own_drift;
    if (n > 0) own_drift.noalias() -= column.transpose().lazyProduct(drifting);
    corner.noalias() += cut_per_N * own_drift * (t.transpose() - t.transpose() * lent * N_tip);
  }
  // Rows that are not held carry nothing any more: λ = 0.
  Mat3 left = Q.transpose() * corner * Q;
  Vec3 given = Q.transpose() * rest;
  const Mat3 free_row = Q.transpose() * (Mat3::Identity() - lent * N_tip) * Q;
  const Vec3 carried = Q.transpose() * (now.head<3>() + lent * free.head<3>());
  const int held_from = held == TipRows::all ? 0 : held == TipRows::axial ? 2 : 3;
  for (int k = 0; k < held_from; ++k) {
    left.row(k) = free_row.row(k);
    given[k] = -carried[k];
  }
  const Vec3 change = Q * Eigen::PartialPivLU<Mat3>(left).solve(given);
  push.head<3>() = now.head<3>() + change;

  auto forces = work_.head(rows());
  forces.head<3>() = push.head<3>() + lent * (free.head<3>() - N_tip * change);
  if (n > 0) {
    right.noalias() -= solved.lazyProduct(change);
    if (drifts) right -= cut_per_N * Q.col(2).dot(change) * drifting;
    push.segment(3, n) = now.segment(3, n) + right.head(n);
    forces.tail(n) = push.segment(3, n);
    grips_.add_lent(right.tail(grips_.spring_rows()), forces.tail(n));
  }
  for (int c = 0; c < count; ++c)
    lambda.segment<3>(3 * c).noalias() = frame[static_cast<std::size_t>(c)].transpose() * forces.segment<3>(3 * c);
  if (held == TipRows::none) lambda.head<3>().setZero();
  if (held == TipRows::axial) lambda.head<2>().setZero();
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
