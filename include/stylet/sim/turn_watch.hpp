// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace stylet {

/// Watches which way a base moves along its own axis, and finds where it turned round. A hand trembles: it has turned
/// once it is so far back from where it was furthest.
class TurnWatch {
 public:
  /// Time, depth and force at one place of the base.
  struct Moment {
    double time_s = 0.0;
    double depth_mm = 0.0;
    double force_N = 0.0;
    bool in_tissue = false;
  };

  /// Whether the base moves outwards.
  [[nodiscard]] bool retracting() const { return retracting_; }

  /// The base has moved on. @param advance_mm along its axis, inwards > 0 @param now the moment at its new place
  /// @return the moment at which it turned round, if the turn is noticed now
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
  /// [mm] A base that is further back than this has turned. Raised, a trembling hand turns less often and a turn is
  /// noticed later.
  static constexpr double kTurn_mm = 0.05;
  /// [mm] Less is rounding.
  static constexpr double kStill_mm = 1e-9;

  double travel_mm_ = 0.0;    ///< of the base along its own axis
  double furthest_mm_ = 0.0;  ///< travel where it was furthest in its present direction
  Moment there_;
  bool retracting_ = false;
};

}  // namespace stylet
