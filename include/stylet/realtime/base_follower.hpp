// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/virtual_coupling.hpp"

namespace stylet {

/// Moves the needle's base through the virtual coupling. The base has no mass: at any moment what the coupling exerts
/// on it equals what the hand would have to exert to hold needle and tissue there. With the offset e of the handle from
/// the base (translation and rotation), its value e₀ a step ago, stiffness K, damping B and the hand's force F of the
/// last step, the base moves by Δ in this step:
///   K (e − Δ) + B (e − Δ − e₀)/T = F + S Δ      (e: new handle, old base)
///   Δ = (K + B/T + S)⁻¹ (K e + B (e − e₀)/T − F)
/// where S stands for how F will change. With S = 0 (explicit) a linear body of stiffness k is stable only for
/// k < K + 2 B/T, which a needle against bone exceeds a thousandfold; with S it is for k < K + 2 B/T + 2 S, so for any
/// k once S ≥ k/2. S is therefore measured: after each step the change y of F and the motion s correct it so that it
/// grows at once to y = S s (a BFGS update, which for a linear body never takes S above the true stiffness in any
/// direction) and shrinks gradually where the body proves softer. A stiffness met for the first time is known before
/// the step that answers it.
/// @cite J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed. (2006), eq. (6.19)
class BaseFollower {
 public:
  struct Limits {
    double speed_mm_per_s = 200.0;  ///< the base never moves faster, so a handle that jumps does not
    double turn_rad_per_s = 6.0;
  };

  /// Without a coupling: the base is where the handle is, but for the limits.
  explicit BaseFollower(const Limits& limits) : limits_(limits) {}
  BaseFollower(const Limits& limits, const VirtualCoupling& coupling);

  /// The base is here, at rest.
  void start(const Pose& base);

  /// Where the base goes now.
  /// @param device handle @param hand what the hand exerts at the present base; if it is not finite the last good one
  /// counts @param dt [s] > 0
  const Pose& follow(const Pose& device, const Wrench& hand, double dt);

  [[nodiscard]] const Pose& base() const { return base_; }
  /// Of the last step.
  [[nodiscard]] const Twist& twist() const { return twist_; }

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;

  [[nodiscard]] Vec6 offset(const Pose& device) const;
  void learn(const Vec6& y);
  void move(const Vec6& by, double dt);

  // Rotations are lengths here (times the lever), torques forces (over the lever).
  Limits limits_;
  bool coupled_ = false;
  double lever_ = 1.0;     ///< [mm]
  Vec6 K_ = Vec6::Zero();  ///< [N/mm] diagonal
  Vec6 B_ = Vec6::Zero();  ///< [N s/mm] diagonal
  Mat6 S_ = Mat6::Zero();  ///< [N/mm] measured stiffness of what the base holds
  Pose base_;
  Twist twist_;
  Vec6 before_ = Vec6::Zero();  ///< offset after the last step
  Vec6 moved_ = Vec6::Zero();   ///< s, of the last step
  Vec6 force_ = Vec6::Zero();   ///< F before the last step
  bool first_ = true;
};

}  // namespace stylet
