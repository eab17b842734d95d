// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_system.hpp"

#include "core/dense_kernels.hpp"

#include <Eigen/LU>

namespace stylet {

ContactSystem::ContactSystem(int contacts) : grips_(contacts - 1) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(contacts);
  A = N = MatX::Zero(n, n);
  free = now = gap = shift = lambda = push = right_ = lent_ = work_ = VecX::Zero(n);
  frame.assign(static_cast<std::size_t>(contacts), Mat3::Identity());
  yield.assign(static_cast<std::size_t>(contacts), Yield{});
  lent_to_.reserve(static_cast<std::size_t>(contacts));
  spring.assign(static_cast<std::size_t>(contacts), Mat3::Zero());
  lent_by_tip_ = column_ = row_ = MatX::Zero(n, 3);
  solved_ = MatX::Zero(n, 4);
}

void ContactSystem::list_lent() {
  lent_to_.clear();
  if (!supported) return;
  for (int c = 0; c < count; ++c) {
    if (!spring[static_cast<std::size_t>(c)].isZero(0.0)) lent_to_.push_back(c);
  }
}

/// lent_ = G way
void ContactSystem::lend(const Eigen::Ref<const VecX>& way) {
  for (const int c : lent_to_)
    lent_.segment<3>(3 * c).noalias() = spring[static_cast<std::size_t>(c)] * way.segment<3>(3 * c);
}

bool ContactSystem::factorise() {
  lacks_tip_ = true;
  list_lent();
  const Eigen::Index n = grip_rows();
  if (n == 0) return true;
  return grips_.factorise(A.block(3, 3, n, n), N.block(3, 3, n, n), grip_springs(), grip_yields());
}

bool ContactSystem::append() {
  lacks_tip_ = true;
  if (grip_count() == 1) return factorise();
  const Eigen::Index n = grip_rows();
  return grips_.append(A.block(3, 3, n, n), N.block(3, 3, n, n), grip_springs(), grip_yields().back());
}

bool ContactSystem::keep_first(int contacts) {
  lacks_tip_ = true;
  count = contacts;
  return grips_.keep_first(contacts - 1);
}

void ContactSystem::add_tip() {
  lacks_tip_ = false;
  const Eigen::Index n = grip_rows();
  if (n == 0) return;
  auto column = column_.topRows(n);
  auto row = row_.topRows(n);
  column = A.block(3, 0, n, 3) + N.block(3, 0, n, 3);
  row = column;
  for (const int c : lent_to_) {
    if (c == 0) continue;
    const Eigen::Index i = 3 * static_cast<Eigen::Index>(c) - 3;
    const Mat3& G = spring[static_cast<std::size_t>(c)];
    auto by_tip = lent_by_tip_.middleRows<3>(i);
    by_tip.noalias() = G * N.block<3, 3>(3 * c, 0);
    const Mat3 by_grip = G * A.block<3, 3>(3 * c, 0);
    dense::subtract_product(column, A.block(3, 3 * c, n, 3), by_tip);
    const Yield then = grips_.yield_of_factor(c - 1);
    for (int k = 0; k < 3; ++k) column.col(k).segment<3>(i) -= then.of(by_tip.col(k));
    dense::subtract_product(row, N.block(3, 3 * c, n, 3), by_grip);
  }
  grips_.solve_base(column);
}

Vec3 ContactSystem::error(int contact) const {
  const auto c = static_cast<std::size_t>(contact);
  const Vec3 off = gap.segment<3>(3 * contact) + yield[c].of(now.segment<3>(3 * contact));
  return frame[c].transpose() * off - shift.segment<3>(3 * contact);
}

double ContactSystem::own_yield(int contact, int k) const {
  const auto c = static_cast<std::size_t>(contact);
  const Vec3 d = frame[c].col(k);
  const Mat3 own = A.block<3, 3>(3 * contact, 3 * contact) + N.block<3, 3>(3 * contact, 3 * contact);
  return d.dot(own * d) + d.dot(yield[c].of(d));
}

bool ContactSystem::solve(TipRows held) {
  const Eigen::Index n = grip_rows();
  if (n > 0 && !grips_.change(grip_yields()) && !factorise()) return false;
  if (lacks_tip_) add_tip();

  auto right = right_.head(rows());
  right = free.head(rows());
  if (supported) {
    lend(free);
    for (const int c : lent_to_) {
      const Vec3 lent = lent_.segment<3>(3 * c);
      right.noalias() -= A.block(0, 3 * c, rows(), 3).lazyProduct(lent);
      right.segment<3>(3 * c) -= yield[static_cast<std::size_t>(c)].of(lent);
    }
  }
  for (int c = 0; c < count; ++c) right.segment<3>(3 * c) -= frame[static_cast<std::size_t>(c)] * error(c);

  // The grips by themselves: B⁻¹ of the tip's columns and of the right-hand side.
  auto solved = solved_.topRows(n);
  if (n > 0) {
    solved.leftCols<3>() = column_.topRows(n);
    solved.col(3) = right.tail(n);
    grips_.solve_base(solved.rightCols<1>());
    grips_.take_changes_in(solved.leftCols<3>(), lent_by_tip_.topRows(supported ? n : 0));
    grips_.take_changes_in(solved.rightCols<1>(), lent_by_tip_.topLeftCorner(0, 0));
  }

  // The tip: its three rows with the grips taken out.
  const Mat3& Q = frame.front();
  Mat3 own = A.topLeftCorner<3, 3>();
  const Yield& tip = yield.front();
  own += (tip.axial - tip.lateral) * tip.along * tip.along.transpose() + tip.lateral * Mat3::Identity();
  const Mat3 N_tip = N.topLeftCorner<3, 3>();
  if (supported) own -= own * spring.front() * N_tip;
  Mat3 corner = own + N_tip;
  Vec3 rest = right.head<3>();
  if (n > 0) {
    for (const int c : lent_to_) {  // by way of the grips
      if (c > 0) corner.noalias() -= A.block<3, 3>(0, 3 * c) * lent_by_tip_.middleRows<3>(3 * c - 3);
    }
    corner.noalias() -= row_.topRows(n).transpose().lazyProduct(solved.leftCols<3>());
    rest.noalias() -= row_.topRows(n).transpose().lazyProduct(solved.col(3));
  }
  corner = (Q.transpose() * corner * Q).eval();
  rest = (Q.transpose() * rest).eval();
  // Rows that are not held carry nothing any more.
  Vec3 change = -(Q.transpose() * now.head<3>());
  if (held == TipRows::all) {
    const Eigen::PartialPivLU<Mat3> lu(corner);
    change = lu.solve(rest);
  } else if (held == TipRows::axial) {
    change[2] = (rest[2] - corner(2, 0) * change[0] - corner(2, 1) * change[1]) / corner(2, 2);
  }
  change = (Q * change).eval();
  push.head<3>() = now.head<3>() + change;
  if (n > 0) push.segment(3, n) = now.segment(3, n) + solved.col(3) - solved.leftCols<3>().lazyProduct(change);

  // λ = p + G (r − r_now), r − r_now = free − N (p − λ_now)
  auto forces = work_.head(rows());
  forces = push.head(rows());
  if (supported) {
    right = push.head(rows()) - now.head(rows());
    for (const int c : lent_to_) {
      const Vec3 way = free.segment<3>(3 * c) - N.block(3 * c, 0, 3, rows()).lazyProduct(right);
      forces.segment<3>(3 * c).noalias() += spring[static_cast<std::size_t>(c)] * way;
    }
  }
  for (int c = 0; c < count; ++c)
    lambda.segment<3>(3 * c).noalias() = frame[static_cast<std::size_t>(c)].transpose() * forces.segment<3>(3 * c);
  if (held == TipRows::none) lambda.head<3>().setZero();
  if (held == TipRows::axial) lambda.head<2>().setZero();
  return push.head(rows()).allFinite();
}

double ContactSystem::axial_excess(int contact) const {
  const auto c = static_cast<std::size_t>(contact);
  Vec3 change = frame[c] * lambda.segment<3>(3 * contact) - now.segment<3>(3 * contact);
  if (supported) change -= spring[c] * free.segment<3>(3 * contact);
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
