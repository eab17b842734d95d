// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/virtual_coupling.hpp"

namespace stylet {

/// Moves the needle's base through the virtual coupling. The base has no mass: at any moment what the coupling exerts
/// on it equals what the hand would have to exert to hold needle and tissue there. With the offset e of the handle
/// (new) from the base (old), translation and rotation, its value e₀ after the last step, stiffness K, damping B and
/// the hand's force F of the last step, the base moves by Δ in this step:
///   K (e − Δ) + B (e − Δ − e₀)/T = F + S (Δ − φ s)
///   Δ = (K + B/T + S)⁻¹ (K e + B (e − e₀)/T − F + φ S s)
/// where S and φ foretell how F will change. With S = 0 (explicit) a linear body of stiffness k is stable only for
/// k < K + 2 B/T, which a needle against bone exceeds a thousandfold; with S and φ = 0 for k < K + 2 B/T + 2 S, so for
/// any k once S ≥ k/2. S is therefore measured: the motion s of a step and the change y of F in it correct S by a BFGS
/// update, which for a linear body keeps S below the true stiffness in every direction where it was below, and above it
/// where it was above. A stiffness met for the first time is known before the step that answers it; as other directions
/// may be as stiff, S then takes it in all of them and unlearns it where the body proves softer, gradually. φ, 0…1, is
/// the share of the foretold change S s that did not come about: a body that slides goes on sliding, and S, which it
/// will need when it sticks again, does not hold the base back.
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

  /// The base stays in this step: nobody says where the handle is. What follows is as after start(), but for S.
  void hold();

  [[nodiscard]] const Pose& base() const { return base_; }
  /// Of the last step.
  [[nodiscard]] const Twist& twist() const { return twist_; }

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;

  [[nodiscard]] Vec6 offset(const Pose& device) const;
  bool stiffen(const Vec6& s, const Vec6& y);
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
  Vec6 before_ = Vec6::Zero();        ///< offset after the last step
  Vec6 moved_ = Vec6::Zero();         ///< s, of the last step
  Vec6 force_ = Vec6::Zero();         ///< F before the last step
  Vec6 moved_before_ = Vec6::Zero();  ///< of the step before
  Vec6 change_ = Vec6::Zero();        ///< y, of the last step
  Vec6 continued_ = Vec6::Zero();     ///< φ s: how it slides on
  bool first_ = true;
};

}  // namespace stylet
