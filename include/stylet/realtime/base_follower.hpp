// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/seen_stiffness.hpp"
#include "stylet/realtime/virtual_coupling.hpp"

namespace stylet {

/// Moves the needle's base through the virtual coupling. The base has no mass: the force and torque that the coupling
/// exerts on it balance those that the hand would have to exert to hold needle and tissue there. Let e be the offset
/// (translation and rotation) of the handle's new pose from the base's old pose, e₀ the offset after the last step, K
/// the stiffness and B the damping of the coupling, F the hand's force of the last step, and T the period. Then the
/// base moves by Δ:
///   K (e − Δ) + B (e − Δ − e₀)/T = F + S (Δ − φ s)
///   Δ = (K + B/T + S)⁻¹ (K e + B (e − e₀)/T − F + φ S s)
/// S and φ predict the change of F. With S = 0 (explicit integration) a linear body of stiffness k is stable only for
/// k < K + 2 B/T, which a needle against bone exceeds a thousandfold; with S and φ = 0 it is stable for
/// k < K + 2 B/T + 2 S, that is for any k once S ≥ k/2.
///
/// S is therefore identified during motion: the motion s of a step and the change y of F in it correct S by a BFGS
/// update. For a linear body this keeps S below the true stiffness in every direction in which it was below, and above
/// in every direction in which it was above. When the last step shows a body much stiffer than S, S is set to the
/// body's stiffness before the next step, in all directions, since other directions may be as stiff; in directions in
/// which the body proves softer, S decreases gradually. φ, 0…1, is the share of the predicted change S s that did not
/// occur: a sliding body is expected to go on sliding, so that S, which is needed when it sticks again, does not hold
/// the base back.
/// @cite J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed. (2006), eq. (6.19)
class BaseFollower {
 public:
  struct Limits {
    double speed_mm_per_s = 200.0;  ///< largest speed of the base, also if the handle jumps
    double turn_rad_per_s = 6.0;    ///< largest angular speed of the base
  };

  /// A follower without a coupling: the base follows the handle exactly, within the limits.
  explicit BaseFollower(const Limits& limits) : limits_(limits) {}
  BaseFollower(const Limits& limits, const VirtualCoupling& coupling);

  /// Starts with the base at rest at this pose, and resets S.
  void start(const Pose& base);

  /// Moves the base by one step.
  /// @param device pose of the handle @param hand force and torque that the hand exerts on the base at its present
  ///   pose; if they are not finite, the last finite ones are used @param dt [s] > 0
  /// @return the new pose of the base
  const Pose& follow(const Pose& device, const Wrench& hand, double dt);

  /// Keeps the base in place for this step, because the pose of the handle is unknown. Afterwards the state is as after
  /// start(), except that S is kept.
  void hold();

  [[nodiscard]] const Pose& base() const { return base_; }
  /// Velocity of the base in the last step.
  [[nodiscard]] const Twist& twist() const { return twist_; }

 private:
  using Vec6 = SeenStiffness::Vec6;

  [[nodiscard]] Vec6 offset(const Pose& device) const;
  void move(const Vec6& by, double dt);

  // In these vectors and matrices, rotations are multiplied by the lever to be lengths, torques divided by it to be
  // forces.
  Limits limits_;
  bool coupled_ = false;
  double lever_ = 1.0;     ///< [mm]
  Vec6 K_ = Vec6::Zero();  ///< [N/mm] diagonal
  Vec6 B_ = Vec6::Zero();  ///< [N s/mm] diagonal
  Pose base_;
  Twist twist_;
  Vec6 before_ = Vec6::Zero();  ///< offset after the last step
  Vec6 moved_ = Vec6::Zero();   ///< s of the last step
  Vec6 force_ = Vec6::Zero();   ///< F before the last step
  SeenStiffness seen_;
  bool first_ = true;  ///< no step since start() or hold()
};

}  // namespace stylet
