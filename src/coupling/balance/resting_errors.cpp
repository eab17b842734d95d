// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_errors.hpp"

namespace stylet {

Eigen::Ref<const VecX> RestingErrors::answer(RestingMatrix& matrix, SlidingRows& sliding) {
  auto z = z_.head(matrix.rows());
  z.setZero();
  for (const int grip : of_) {
    sliding.know(grip, matrix);  // B itself may have the yield of a contact that slides
    z -= mm_[static_cast<std::size_t>(grip)] * sliding.column(grip, matrix);
  }
  clear();
  sliding.yield_in(z, matrix);
  auto forces = forces_.head(matrix.contact_rows());
  matrix.forces(z, forces);
  return forces;
}

}  // namespace stylet
