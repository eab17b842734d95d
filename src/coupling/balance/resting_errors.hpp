// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/resting_matrix.hpp"
#include "coupling/balance/sliding_rows.hpp"

#include <vector>

namespace stylet {

/// Errors along the needle at contacts at rest, which arise where a contact begins another sub-step of sliding or
/// changes its state, and their answer −B⁻¹ E e. Nothing allocates after construction.
class RestingErrors {
 public:
  explicit RestingErrors(int grips)
      : mm_(static_cast<std::size_t>(grips)), z_(VecX::Zero(RestingMatrix::most_rows(grips))), forces_(z_) {
    of_.reserve(static_cast<std::size_t>(grips));
  }

  [[nodiscard]] bool are_any() const { return !of_.empty(); }
  /// The contacts at rest with errors. @return numbers from 0 on
  [[nodiscard]] const std::vector<int>& contacts() const { return of_; }
  void clear() { of_.clear(); }
  /// Sets the error of a contact that has none yet [mm].
  void set(int grip, double mm) {
    of_.push_back(grip);
    mm_[static_cast<std::size_t>(grip)] = mm;
  }
  /// Adds to the error of a contact that has one.
  void add(int grip, double mm) { mm_[static_cast<std::size_t>(grip)] += mm; }

  /// Clears the errors. @return [N] (3 grips) the answer as changes of the forces, a view of work space
  [[nodiscard]] Eigen::Ref<const VecX> answer(RestingMatrix& matrix, SlidingRows& sliding);

 private:
  std::vector<int> of_;
  std::vector<double> mm_;  ///< (grips)
  VecX z_, forces_;         ///< work space
};

}  // namespace stylet
