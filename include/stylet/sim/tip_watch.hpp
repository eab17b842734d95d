// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"

#include <optional>

namespace stylet {

/// Where the tip is in the tissue, less where it was to be.
struct TipError {
  Vec3 mm = Vec3::Zero();      ///< LPS, in the undeformed patient: tip_error_mm() of a report
  double base_depth_mm = 0.0;  ///< Step::base_depth_mm of the step that it is of
};

/// Follows an insertion step by step for the error of its tip at the deepest, as a report has it. A needle that is
/// drawn back keeps the error of its deepest step: behind the end of its track the tip is on its way out, not off its
/// way. Does not allocate.
class TipWatch {
 public:
  /// After every step. A step that was not taken changes nothing.
  void follow(const Insertion& insertion, const Step& step);

  /// Of the deepest step so far, of several the last; empty while the tip is not in the tissue.
  [[nodiscard]] const std::optional<TipError>& deepest() const { return deepest_; }

 private:
  std::optional<TipError> deepest_;
};

}  // namespace stylet
