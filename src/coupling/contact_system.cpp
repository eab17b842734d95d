// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_system.hpp"

#include <Eigen/LU>

namespace stylet {

ContactSystem::ContactSystem(int contacts) : grips_(contacts - 1) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(contacts);
  A = N = MatX::Zero(n, n);
  free = now = gap = shift = lambda = push = right_ = lent_ = work_ = VecX::Zero(n);
  frame.assign(static_cast<std::size_t>(contacts), Mat3::Identity());
  yield.assign(static_cast<std::size_t>(contacts), Yield{});
  spring.assign(static_cast<std::size_t>(contacts), Mat3::Zero());
  lent_by_tip_ = column_ = row_ = MatX::Zero(n, 3);
  solved_ = MatX::Zero(n, 4);
}

/// lent_ = G way
void ContactSystem::lend(const Eigen::Ref<const VecX>& way) {
  for (int c = 0; c < count; ++c)
    lent_.segment<3>(3 * c).noalias() = spring[static_cast<std::size_t>(c)] * way.segment<3>(3 * c);
}

bool ContactSystem::factorise() {
  const Eigen::Index n = grip_rows();
  if (n == 0) return true;
  const auto A_gg = A.block(3, 3, n, n);
  const auto N_gg = N.block(3, 3, n, n);
  const auto springs = supported ? std::span<const Mat3>(spring).subspan(1, grip_count()) : std::span<const Mat3>();
  return grips_.factorise(A_gg, N_gg, springs, grip_yields());
}

bool ContactSystem::keep_first(int contacts) {
  count = contacts;
  return grips_.keep_first(contacts - 1);
}

void ContactSystem::add_tip() {
  const Eigen::Index n = grip_rows();
  if (n == 0) return;
  const Mat3& Q = frame.front();
  column_.topRows(n).noalias() = A.block(3, 0, n, 3).lazyProduct(Q);
  column_.topRows(n).noalias() += N.block(3, 0, n, 3).lazyProduct(Q);
  row_.topRows(n) = column_.topRows(n);
  if (!supported) return;
  for (int k = 0; k < 3; ++k) {
    work_.head(rows()).noalias() = N.topRows(rows()).leftCols<3>().lazyProduct(Q.col(k));
    lend(work_);
    lent_by_tip_.col(k).head(n) = lent_.segment(3, n);
    column_.col(k).head(n).noalias() -= A.block(3, 3, n, n) * lent_.segment(3, n);
    work_.head(rows()).noalias() = A.topRows(rows()).leftCols<3>().lazyProduct(Q.col(k));
    lend(work_);
    row_.col(k).head(n).noalias() -= N.block(3, 3, n, n) * lent_.segment(3, n);
  }
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

  auto right = right_.head(rows());
  right = free.head(rows());
  if (supported) {
    lend(free);
    const auto lent = lent_.head(rows());
    right.noalias() -= A.topLeftCorner(rows(), rows()) * lent;
    for (int c = 0; c < count; ++c)
      right.segment<3>(3 * c) -= yield[static_cast<std::size_t>(c)].of(lent.segment<3>(3 * c));
  }
  for (int c = 0; c < count; ++c) right.segment<3>(3 * c) -= frame[static_cast<std::size_t>(c)] * error(c);

  // The grips by themselves: B⁻¹ of the tip's columns and of the right-hand side.
  auto solved = solved_.topRows(n);
  if (n > 0) {
    solved.leftCols<3>() = column_.topRows(n);
    if (supported) {  // − D G N of grips and tip
      for (int k = 0; k < 3; ++k) {
        for (int c = 1; c < count; ++c)
          solved.col(k).segment<3>(3 * c - 3) -=
              yield[static_cast<std::size_t>(c)].of(lent_by_tip_.col(k).segment<3>(3 * c - 3));
      }
    }
    solved.col(3) = right.tail(n);
    grips_.solve(solved);
  }

  // The tip: its three rows with the grips taken out.
  const Mat3& Q = frame.front();
  Mat3 own = A.topLeftCorner<3, 3>();
  const Yield& tip = yield.front();
  own += (tip.axial - tip.lateral) * tip.along * tip.along.transpose() + tip.lateral * Mat3::Identity();
  const Mat3 N_tip = N.topLeftCorner<3, 3>();
  if (supported) own -= own * spring.front() * N_tip;
  Mat3 corner = Q.transpose() * (own + N_tip) * Q;
  Vec3 rest = Q.transpose() * right.head<3>();
  if (n > 0) {
    if (supported) {
      Mat3 through = Mat3::Zero();  // A G N of the tip, by way of the grips
      for (int c = 1; c < count; ++c)
        through += A.block<3, 3>(0, 3 * c) * spring[static_cast<std::size_t>(c)] * N.block<3, 3>(3 * c, 0);
      corner -= Q.transpose() * through * Q;
    }
    corner.noalias() -= row_.topRows(n).transpose().lazyProduct(solved.leftCols<3>());
    rest.noalias() -= row_.topRows(n).transpose().lazyProduct(solved.col(3));
  }
  // Rows that are not held carry nothing any more.
  Vec3 change = -(Q.transpose() * now.head<3>());
  if (held == TipRows::all) {
    const Eigen::PartialPivLU<Mat3> lu(corner);
    change = lu.solve(rest);
  } else if (held == TipRows::axial) {
    change[2] = (rest[2] - corner(2, 0) * change[0] - corner(2, 1) * change[1]) / corner(2, 2);
  }
  push.head<3>() = now.head<3>() + Q * change;
  if (n > 0) push.segment(3, n) = now.segment(3, n) + solved.col(3) - solved.leftCols<3>().lazyProduct(change);

  // λ = p + G (r − r_now), r − r_now = free − N (p − λ_now)
  auto forces = work_.head(rows());
  forces = push.head(rows());
  if (supported) {
    right = push.head(rows()) - now.head(rows());
    lent_.head(rows()).noalias() = N.topLeftCorner(rows(), rows()) * right;
    right = free.head(rows()) - lent_.head(rows());
    lend(right);
    forces += lent_.head(rows());
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
