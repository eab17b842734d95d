// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/contact_system.hpp"

#include "core/dense_kernels.hpp"

#include <Eigen/LU>

#include <utility>

namespace stylet {

ContactSystem::ContactSystem(const ContactRows& rows, int most, int at_rest)
    : needle(most),
      prepared(most),
      rows_(rows),
      grips_(most - 1 - at_rest),
      prepared_grips_(most - 1 - at_rest),
      columns_(most - at_rest),
      resting_(rows, at_rest, most - at_rest) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(most);
  const Eigen::Index own = 3 * static_cast<Eigen::Index>(most - at_rest);
  A = MatX::Zero(dense::column_length(n), n);
  lambda = push = work_ = VecX::Zero(n);
  drift_ = others_ = VecX::Zero(own);
  beyond_ = MatX::Zero(dense::column_length(own), 3);
}

bool ContactSystem::factorise() {
  columns_.outdate();
  const Eigen::Index n = grip_rows();
  const Eigen::Index at = first_row();
  fits_ = resting_.fit(A, needle) && (n == 0 || grips_.factorise(seen().block(3, 3, n, n), needle.N.block(at, at, n, n),
                                                                 springs_of(needle), yields_of(needle)));
  needle.made_for = resting_.version();
  return fits_;
}

bool ContactSystem::append() {
  if (!fits_) return false;
  columns_.outdate();
  const Eigen::Index n = grip_rows();
  const Eigen::Index at = first_row();
  if (n == 3) return factorise();
  resting_.take_contacts(A, needle);
  fits_ = grips_.append(seen().block(3, 3, n, n), needle.N.block(at, at, n, n), yields_of(needle).back());
  return fits_;
}

bool ContactSystem::keep_first(int contacts) {
  needle.count = contacts;
  resting_.keep_first(contacts - resting_.count());
  if (!fits_) return false;
  columns_.outdate();
  fits_ = grips_.keep_first(contacts - 1 - resting_.count());
  return fits_;
}

void ContactSystem::fill_prepared() {
  prepared.made_for = resting_.version();
  const Eigen::Index at = first_row();
  const Eigen::Index n = prepared.rows() - at;
  prepared_grips_.fill(seen().block(3, 3, n, n), prepared.N.block(at, at, n, n), springs_of(prepared),
                       yields_of(prepared));
}

bool ContactSystem::factorise_prepared() { return prepared_grips_.factorise_filled(); }

void ContactSystem::take_prepared() {
  columns_.outdate();
  std::swap(needle, prepared);
  std::swap(grips_, prepared_grips_);
  resting_.keep_first(needle.count - resting_.count());
  fits_ = true;
}

void ContactSystem::add_tip() {
  columns_.outdate();
  resting_.move_tip();
}

Vec3 ContactSystem::own_yield(int contact) const {
  const auto c = static_cast<std::size_t>(contact);
  const Mat3& Q = rows_.frame[c];
  const Mat3 own = A.block<3, 3>(3 * contact, 3 * contact) + needle.N.block<3, 3>(3 * contact, 3 * contact);
  const Yield& yield = rows_.yield[c];
  Vec3 result;
  for (int k = 0; k < 3; ++k) {
    const Vec3 q = Q.col(k);
    const double along = q.dot(yield.along);
    result[k] = q.dot(own * q) + yield.lateral + (yield.axial - yield.lateral) * along * along;
  }
  return result;
}

/// Solves the rows of shaft contacts and springs without the tip: B⁻¹ of the tip's columns, of the right-hand side and
/// of the drift.
bool ContactSystem::solve_grips() {
  const Eigen::Index n = grip_rows();
  if (resting_.are_any()) {
    const bool fit = resting_.follow() && needle.made_for == resting_.version();
    if (!fit && !factorise()) return false;
    resting_.solve(A, needle);
  }
  if (n > 0 && !grips_.change(yields_of(needle)) && !(factorise() && grips_.change(yields_of(needle)))) return false;
  if (!columns_.is_current()) columns_.take_tip(seen(), needle, first_row(), grips_);
  if (rows_.tip.drifts()) {
    drift_.head<3>() = rows_.tip.drift.head<3>();
    drift_.segment(3, n) = rows_.tip.drift.segment(first_row(), n);
    if (resting_.are_any()) resting_.correct_drift(drift_.head(3 + n));
  }
  if (n == 0) return true;

  const Eigen::Index all = grips_.rows();
  auto right = columns_.right(all);
  for (int own = 1; load(own) < needle.count; ++own)
    right.segment<3>(3 * own - 3).noalias() = rows_.frame[static_cast<std::size_t>(load(own))] * error(own);
  grips_.across(right.head(n), right.tail(grips_.spring_rows()));
  right = -right;
  right.head(n) += needle.free.segment(first_row(), n);
  if (rows_.tip.drifts()) {
    auto drift = columns_.drift(all);
    drift.head(n) = drift_.segment(3, n);
    grips_.across(drift.head(n), drift.tail(grips_.spring_rows()));
  }
  columns_.solve(needle, grips_, rows_.tip.drifts());
  if (rows_.tip.drifts()) right -= rows_.tip.cut_due * columns_.drift(all);
  return true;
}

/// Solves the tip's three rows, after elimination of the others.
/// @return π of the tip, and the force φ of the spring there
std::pair<Vec3, Vec3> ContactSystem::solve_tip(TipRows held) {
  const Eigen::Index n = grip_rows();
  const Eigen::Index at = first_row();
  const Eigen::Index all = n > 0 ? grips_.rows() : 0;
  const auto column = columns_.push(all);
  const auto solved = columns_.solved_push(all);
  const auto of_spring = columns_.solved_spring(all);
  const auto right = std::as_const(columns_).right(all);
  const auto drifting = std::as_const(columns_).drift(all);
  const MatX& N = needle.N;
  const VecX& free = needle.free;
  const TipMotion& motion = rows_.tip;
  const Mat3& Q = rows_.frame.front();
  const Vec3 t = Q.col(2);
  const Mat3 N_tip = N.topLeftCorner<3, 3>();

  // The compliance of tissue and contact, by which π and φ move the tip, and the error of the tip's rows.
  const Yield& tip = rows_.yield.front();
  Mat3 own = seen().topLeftCorner<3, 3>();
  own += (tip.axial - tip.lateral) * tip.along * tip.along.transpose() + tip.lateral * Mat3::Identity();
  Mat3 corner = N_tip;
  Vec3 rest = free.head<3>() - Q * error(0);
  if (motion.drifts()) {
    own.noalias() += motion.cut_per_N * drift_.head<3>() * t.transpose();
    rest -= motion.cut_due * drift_.head<3>();
  }
  if (n > 0) {
    corner.noalias() -= column.transpose().lazyProduct(solved);
    rest.noalias() -= column.transpose().lazyProduct(right);
    if (motion.drifts()) {
      const Vec3 by_grips = column.transpose().lazyProduct(drifting);
      own.noalias() -= motion.cut_per_N * by_grips * t.transpose();
    }
  }
  corner += own;

  Along lent;  // φ
  if (needle.lends_at_tip()) {
    const Mat3 G = needle.spring.front().matrix();
    Along moves = {free.head<3>(), N_tip};
    Mat3 borne = Mat3::Identity();
    if (n > 0) {
      const Mat3 per_lent = subtract_grips(N.block(at, 0, n, 3), moves);
      own.noalias() -= column.transpose().lazyProduct(of_spring);
      borne.noalias() += G * per_lent;
    }
    const Eigen::PartialPivLU<Mat3> carried(borne);
    lent = {carried.solve(G * moves.at), carried.solve(G * moves.per)};
    corner.noalias() -= own * lent.per;
    rest.noalias() -= own * lent.at;
  }

  // In a row that is not held, the force becomes zero: λ = 0.
  Mat3 left = Q.transpose() * corner * Q;
  Vec3 given = Q.transpose() * rest;
  const Mat3 free_row = Q.transpose() * (Mat3::Identity() - lent.per) * Q;
  const Vec3 carried = Q.transpose() * (rows_.now.head<3>() + lent.at);
  const int held_from = held == TipRows::all ? 0 : held == TipRows::axial ? 2 : 3;
  for (int k = 0; k < held_from; ++k) {
    left.row(k) = free_row.row(k);
    given[k] = -carried[k];
  }
  if (turns(held)) {
    // The force turns with the tip's direction, and so does the part of the lateral gap that lies along it.
    const Eigen::Index g = 3 * static_cast<Eigen::Index>(motion.behind);
    Along turn = {free.head<3>() - free.segment<3>(g), N_tip - N.block<3, 3>(g, 0)};
    beyond_.topRows(n) = N.block(at, 0, n, 3) - N.block(at, g, n, 3);
    const Mat3 per_lent = subtract_grips(beyond_.topRows(n), turn);
    turn.at -= per_lent * lent.at;
    turn.per -= per_lent * lent.per;
    const double pressed = t.dot(rows_.now.head<3>()) / motion.behind_mm;
    const Vec3 aside = Q.leftCols<2>() * rows_.error(0).head<2>() / motion.behind_mm;
    left.topRows<2>() += pressed * Q.leftCols<2>().transpose() * turn.per * Q;
    given.head<2>() += pressed * Q.leftCols<2>().transpose() * turn.at;
    left.row(2) -= aside.transpose() * turn.per * Q;
    given[2] -= aside.dot(turn.at);
  }
  const Vec3 change = Q * Eigen::PartialPivLU<Mat3>(left).solve(given);
  return {change, lent.at - lent.per * change};
}

/// Subtracts the part of a motion, at − per π_0, that the pushes of the shaft contacts cause.
/// @param columns columns of N that give the motion by those pushes
/// @return matrix M of the motion −M φ that the tip's spring causes through the shaft contacts
Mat3 ContactSystem::subtract_grips(const Eigen::Ref<const MatX>& columns, Along& moves) const {
  const Eigen::Index n = grip_rows();
  const auto row = columns.transpose();
  moves.per -= Mat3(row.lazyProduct(columns_.solved_push(n)));
  moves.at -= Vec3(row.lazyProduct(columns_.right(n)));
  Mat3 per_lent = Mat3::Zero();
  if (needle.lends_at_tip()) per_lent = -Mat3(row.lazyProduct(columns_.solved_spring(n)));
  if (rows_.tip.drifts()) {
    const Vec3 more = row.lazyProduct(columns_.drift(n));
    const Mat3 per_force = rows_.tip.cut_per_N * more * rows_.frame.front().col(2).transpose();
    moves.per -= per_force;
    per_lent -= per_force;
  }
  return per_lent;
}

bool ContactSystem::solve(TipRows held) {
  fits_ = solve_grips();
  if (!fits_) return false;
  const auto [change, lent] = solve_tip(held);
  push.head<3>() = rows_.now.head<3>() + change;

  const Eigen::Index n = grip_rows();
  const Eigen::Index at = first_row();
  auto forces = work_.head(needle.rows());
  forces.head<3>() = push.head<3>() + lent;
  if (n > 0) {
    const Eigen::Index all = grips_.rows();
    auto right = columns_.right(all);
    right.noalias() -= columns_.solved_push(all).lazyProduct(change);
    if (needle.lends_at_tip()) right.noalias() -= columns_.solved_spring(all).lazyProduct(lent);
    if (rows_.tip.drifts())
      right -= rows_.tip.cut_per_N * rows_.frame.front().col(2).dot(change + lent) * columns_.drift(all);
    push.segment(at, n) = rows_.now.segment(at, n) + right.head(n);
    forces.tail(n) = push.segment(at, n);
    grips_.add_lent(right.tail(grips_.spring_rows()), forces.tail(n));
  }
  if (resting_.are_any()) {
    auto others = others_.head(3 + n);
    others.head<3>() = change + lent;
    others.tail(n) = forces.tail(n) - rows_.now.segment(at, n);
    const TipMotion& tip = rows_.tip;
    const double cut = tip.drifts() ? tip.cut_due + tip.cut_per_N * rows_.frame.front().col(2).dot(change + lent) : 0.0;
    resting_.finish(others, cut, push, forces);
  }
  for (int c = 0; c < needle.count; ++c) {
    lambda.segment<3>(3 * c).noalias() =
        rows_.frame[static_cast<std::size_t>(c)].transpose() * forces.segment<3>(3 * c);
  }
  if (held == TipRows::none) lambda.head<3>().setZero();
  if (held == TipRows::axial && !turns(held)) lambda.head<2>().setZero();
  fits_ = push.head(needle.rows()).allFinite();
  return fits_;
}

bool ContactSystem::settle_rest() {
  if (!resting_.follow()) return false;
  resting_.move_tip();
  resting_.solve_all(true);
  resting_.solve(A, needle);
  auto forces = work_.head(first_row());
  resting_.settle(push, forces);
  for (Eigen::Index c = 1; 3 * c < first_row(); ++c)
    lambda.segment<3>(3 * c).noalias() =
        rows_.frame[static_cast<std::size_t>(c)].transpose() * forces.segment<3>(3 * c);
  return true;
}

double ContactSystem::axial_excess(int contact) const {
  const auto c = static_cast<std::size_t>(contact);
  const Vec3 change = rows_.frame[c] * lambda.segment<3>(3 * contact) - rows_.now.segment<3>(3 * contact);
  const Yield used =
      c < first_grip() ? resting_.yield(contact - 1) : grips_.yield(contact - static_cast<int>(first_grip()));
  return rows_.frame[c].col(2).dot(used.of(change) - rows_.yield[c].of(change));
}

double ContactSystem::opening() const {
  const Vec3 t = rows_.frame.front().col(2);
  Vec3 way = needle.free.head<3>() - rows_.gap.head<3>();
  for (int c = 0; c < needle.count; ++c) {
    const Vec3 now = rows_.now.segment<3>(3 * c);
    const Vec3 force = rows_.frame[static_cast<std::size_t>(c)] * lambda.segment<3>(3 * c);
    way -= needle.N.block<3, 3>(0, 3 * c) * (push.segment<3>(3 * c) - now);
    way -= A.block<3, 3>(0, 3 * c) * (force - now);
  }
  return t.dot(way);
}

}  // namespace stylet
