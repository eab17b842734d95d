// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_errors.hpp"

namespace stylet {

void RestingErrors::answer(RestingMatrix& matrix, const SlidingRows& sliding, VecX& z) {
  bool solves = false;
  for (const int grip : of_) {
    const double mm = mm_[static_cast<std::size_t>(grip)];
    if (sliding.is_known(grip)) {
      z.head(matrix.rows()) -= mm * sliding.column(grip, matrix);
      continue;
    }
    if (!solves) rows_.setZero();
    solves = true;
    rows_.block<3, 1>(3 * grip, 0) = -mm * matrix.yield(grip).along;
  }
  clear();
  if (!solves) return;
  auto rows = rows_.topRows(matrix.rows());
  matrix.fill_springs(rows.col(0));
  matrix.solve(rows);
  z.head(matrix.rows()) += rows.col(0);
}

}  // namespace stylet
