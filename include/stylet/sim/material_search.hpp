// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace stylet {

/// A point of the tissue that is at a given place in the room.
struct FoundMaterial {
  Vec3 x = Vec3::Zero();                 ///< [mm] LPS, its place in the tissue at rest
  Insertion::PointDisplacement moved{};  ///< its displacement, x + moved.whole is the place in the room
};

/// Finds the material point that the displacement brings to a place in the room: X with X + u(X) = place. The iteration
/// X ← place − u(X) converges as long as the tissue is not strained by more than its own length. Each call of add()
/// takes one displacement, so that a loop may spread the search over several steps. Nothing allocates.
class MaterialSearch {
 public:
  /// @param place [mm] LPS, in the room @param exact_mm a point that comes this near to the place ends the search
  /// @param most_iterations largest number of calls of add()
  explicit MaterialSearch(const Vec3& place, double exact_mm = 1e-10, int most_iterations = 150)
      : place_(place), x_(place), exact_mm_(exact_mm), left_(most_iterations) {}

  /// The point [mm] LPS whose displacement is wanted next.
  [[nodiscard]] const Vec3& x() const { return x_; }
  [[nodiscard]] bool is_done() const { return left_ == 0; }
  /// Takes the displacement of x(); an empty one, which is not known, ends the search.
  void add(const std::optional<Insertion::PointDisplacement>& u) {
    if (left_ == 0) return;
    --left_;
    if (!u) {
      left_ = 0;
      return;
    }
    const Vec3 off = place_ - x_ - u->whole;
    if (off.norm() < least_) {
      least_ = off.norm();
      nearest_ = FoundMaterial{x_, *u};
      if (least_ < exact_mm_) {
        left_ = 0;
        return;
      }
    }
    // Right beside the needle the displacement changes within its radius, and full steps may overshoot.
    if (off.norm() > 0.9 * last_) step_ = std::max(0.05, 0.7 * step_);
    last_ = off.norm();
    x_ += step_ * off;
  }

  /// The point that comes nearest to the place so far; empty if none comes nearer than 0.2 mm. Where the displacement
  /// jumps from element to element, no point may be exactly at the place.
  [[nodiscard]] const std::optional<FoundMaterial>& found() const { return nearest_; }

 private:
  static constexpr double kNearEnough_mm = 0.2;

  Vec3 place_;
  Vec3 x_;
  double exact_mm_;
  int left_;
  double step_ = 1.0;
  double last_ = std::numeric_limits<double>::max();
  double least_ = kNearEnough_mm;
  std::optional<FoundMaterial> nearest_;
};

}  // namespace stylet
