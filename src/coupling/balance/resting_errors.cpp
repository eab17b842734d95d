// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_errors.hpp"

namespace stylet {

void RestingErrors::answer(RestingMatrix& matrix, SlidingRows& sliding, VecX& z) {
  for (const int grip : of_) {
    sliding.know(grip, matrix);  // B itself may have the yield of a contact that slides
    z.head(matrix.rows()) -= mm_[static_cast<std::size_t>(grip)] * sliding.column(grip, matrix);
  }
  clear();
}

}  // namespace stylet
