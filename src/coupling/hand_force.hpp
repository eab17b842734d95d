// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/shaft_contact.hpp"
#include "stylet/needle/needle.hpp"

namespace stylet {

/// The force that the hand exerts on the needle's base: it balances the forces of the contacts and of the guide.
class HandForce {
 public:
  /// Both arguments outlive this object. @param base pose of the needle's base as the hand gives it
  HandForce(const Pose& base, const Needle& needle) : base_(base), needle_(needle) {}

  /// The present force of the hand [N] LPS.
  [[nodiscard]] Vec3 now(const ContactForces& contacts) const {
    Vec3 force = contacts.tip - needle_.guide_load().force;
    for (const ShaftContact& contact : contacts.shaft) force += contact.force;
    return force;
  }

  /// Begins a sub-step. @param balanced whether the sub-step before ended in a balance
  void begin(const ContactForces& contacts, bool balanced) {
    start_ = now(contacts);
    balanced_ = balanced;
  }

  /// Axial force of the hand [N] at the moment when the axial force of the tip on the tissue reached `limit` [N], by
  /// linear interpolation between the balance before and the present one; the present force where there was no balance
  /// before.
  /// @param tip_start [N] LPS, force of the tip in the balance before
  [[nodiscard]] double when_tip_reached(double limit, const Vec3& tip_start, const ContactForces& contacts) const {
    const Vec3 t = needle_.tangent(needle_.length());
    const double before = tip_start.dot(t);
    const double present = contacts.tip.dot(t);
    const double part = balanced_ && before < limit ? (limit - before) / (present - before) : 1.0;
    return (start_ + part * (now(contacts) - start_)).dot(base_.rotation * Vec3::UnitZ());
  }

 private:
  const Pose& base_;
  const Needle& needle_;
  Vec3 start_ = Vec3::Zero();  ///< [N] LPS, at the start of the sub-step
  bool balanced_ = true;
};

}  // namespace stylet
