// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/grip_columns.hpp"

namespace stylet {

GripColumns::GripColumns(int most) {
  const Eigen::Index rows = 5 * static_cast<Eigen::Index>(most);  // three for each contact, two for each spring
  column_ = begun_ = MatX::Zero(rows, kRight);
  solved_ = MatX::Zero(rows, kDrift + 1);
}

void GripColumns::take_tip(const MatX& A, const NeedleSide& needle, Eigen::Index first, GripMatrix& grips) {
  current_ = true;
  solved_for_ = 0;
  const Eigen::Index n = needle.rows() - first;
  if (n == 0) return;
  // Columns of a push at the tip, and of a force of the tip's spring, which acts on the tissue only.
  auto column = column_.topRows(grips.rows());
  for (int k = 0; k < 3; ++k) {
    auto of_spring = column.col(k);
    of_spring.head(n) = A.block(3, k, n, 1);
    grips.across(of_spring.head(n), of_spring.tail(grips.spring_rows()));
  }
  column.rightCols<3>() = column.leftCols<3>();
  column.rightCols<3>().topRows(n) += needle.N.block(first, 0, n, 3);
  begun_.topRows(grips.rows()) = column;
  grips.begin(begun_.block(0, kTip, grips.rows(), 3));
  if (needle.lends_at_tip()) grips.begin(begun_.block(0, kSpring, grips.rows(), 3));
}

void GripColumns::solve(const NeedleSide& needle, GripMatrix& grips, bool drifts) {
  const Eigen::Index all = grips.rows();
  const Eigen::Index rights = drifts ? 2 : 1;
  grips.begin(solved_.block(0, kRight, all, rights));
  const bool anew = solved_for_ != grips.version();
  if (anew) solved_.block(0, kTip, all, 3) = begun_.block(0, kTip, all, 3);
  const Eigen::Index from = anew ? kTip : kRight;
  grips.finish(solved_.block(0, from, all, kRight + rights - from));
  if (anew && needle.lends_at_tip()) {
    solved_.block(0, kSpring, all, 3) = begun_.block(0, kSpring, all, 3);
    grips.finish(solved_.block(0, kSpring, all, 3));
  }
  solved_for_ = grips.version();
}

}  // namespace stylet
