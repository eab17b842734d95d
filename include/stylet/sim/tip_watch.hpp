// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"

#include <optional>

namespace stylet {

/// Tip error of a step: place of the tip in the tissue minus its planned place.
struct TipError {
  Vec3 mm = Vec3::Zero();      ///< LPS, in the undeformed patient; see Summary::tip_error_mm
  double base_depth_mm = 0.0;  ///< Step::base_depth_mm of the step
};

/// Follows an insertion step by step and keeps the tip error of its deepest step, as in a report. While the needle is
/// drawn back, the tip is behind the end of its track and its distance from the plan is not an error. Does not
/// allocate.
class TipWatch {
 public:
  /// Call after every step. A step that was refused (Step::invalid_input) changes nothing.
  void follow(const Insertion& insertion, const Step& step);

  /// Tip error of the deepest step; of several equally deep steps the last one. Empty while the tip is not in the
  /// tissue.
  [[nodiscard]] const std::optional<TipError>& deepest() const { return deepest_; }

 private:
  std::optional<TipError> deepest_;
};

}  // namespace stylet
