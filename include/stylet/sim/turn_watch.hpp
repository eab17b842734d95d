// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace stylet {

/// Follows the motion of a base along its own axis and finds where it turned round. Since a hand trembles, the base
/// counts as turned only when it is kTurn_mm behind its furthest place.
class TurnWatch {
 public:
  /// State of the insertion at one place of the base.
  struct Moment {
    double time_s = 0.0;
    double depth_mm = 0.0;  ///< base depth
    double force_N = 0.0;   ///< axial force of the hand
    bool in_tissue = false;
  };

  /// Whether the base moves outwards.
  [[nodiscard]] bool retracting() const { return retracting_; }

  /// Call after every motion of the base.
  /// @param advance_mm motion along its axis, inwards > 0 @param now the moment at the base's new place
  /// @return the moment at which the base turned round, if this call detects a turn
  std::optional<Moment> follow(double advance_mm, const Moment& now) {
    travel_mm_ += advance_mm;
    const double back = retracting_ ? travel_mm_ - furthest_mm_ : furthest_mm_ - travel_mm_;
    std::optional<Moment> turned;
    if (back > kStill_mm && back <= kTurn_mm) return turned;
    if (back > kTurn_mm) {
      retracting_ = !retracting_;
      turned = there_;
    }
    furthest_mm_ = travel_mm_;
    there_ = now;
    return turned;
  }

 private:
  /// [mm] A base that is further back than this has turned. A larger value ignores stronger trembling and detects turns
  /// later.
  static constexpr double kTurn_mm = 0.05;
  /// [mm] Smaller motions are rounding errors.
  static constexpr double kStill_mm = 1e-9;

  double travel_mm_ = 0.0;    ///< position of the base along its own axis
  double furthest_mm_ = 0.0;  ///< furthest value of travel_mm_ in the present direction
  Moment there_;              ///< the moment at furthest_mm_
  bool retracting_ = false;
};

}  // namespace stylet
