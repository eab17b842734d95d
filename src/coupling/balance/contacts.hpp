// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/largest.hpp"
#include "coupling/balance/needle_bundle.hpp"
#include "coupling/contacts/shaft_contacts.hpp"
#include "coupling/tip/tip_contact.hpp"

#include <algorithm>

namespace stylet {

/// All contacts between needles and tissue, numbered like the loads on them: 0 is the tip of the needle that the hand
/// moves. The contacts of needles at rest follow, needle by needle, and then the shaft contacts of the needle that the
/// hand moves, from the base on. A view without data of its own.
struct Contacts {
  Needle& needle;  ///< the needle that the hand moves; with needles at rest, `bundle`
  TissueResponse& tissue;
  TipContact& tip;
  ShaftContacts& shaft;
  NeedleBundle* bundle = nullptr;  ///< all needles, where some rest in the tissue
  bool without_others = false;     ///< only the contacts of the needle that the hand moves (TissueHold)

  /// The shaft contacts.
  [[nodiscard]] std::span<ShaftContact> grips() const { return without_others ? shaft.own() : shaft.all(); }
  [[nodiscard]] int count() const { return 1 + static_cast<int>(grips().size()); }
  [[nodiscard]] ShaftContact& of_shaft(int load) const { return grips()[static_cast<std::size_t>(load - 1)]; }
  /// Number of the first shaft contact of the needle that the hand moves.
  [[nodiscard]] int first_own() const { return without_others ? 1 : 1 + static_cast<int>(shaft.others()); }
  /// The needle of a contact.
  [[nodiscard]] const Needle& needle_of(int load) const {
    return load < first_own() && load > 0 ? *of_shaft(load).needle : needle;
  }
  /// Number of a contact's point in ContactCompliance.
  [[nodiscard]] int point(int load) const { return load == 0 ? ContactCompliance::kTip : of_shaft(load).point; }
  /// [N] LPS, on the tissue.
  [[nodiscard]] Vec3& force(int load) const { return load == 0 ? tip.force : of_shaft(load).force; }
  /// [mm] LPS, undeformed place of the contact's tissue point.
  [[nodiscard]] const Vec3& material(int load) const { return load == 0 ? tip.cut.x() : of_shaft(load).x; }
  /// [mm] Arc length of the contact on its needle, clamped to that needle's length.
  [[nodiscard]] double arc(int load) const {
    return load == 0 ? needle.length() : std::clamp(of_shaft(load).s, 0.0, needle_of(load).length());
  }
  [[nodiscard]] ContactForces forces() const { return {tip.force, grips()}; }
  /// Those of the needle that the hand moves.
  [[nodiscard]] ContactForces own_forces() const { return {tip.force, shaft.own()}; }
  /// [mm] LPS, displacement of a point of ContactCompliance by all forces.
  [[nodiscard]] Vec3 displacement(int point) const { return tissue.displacement(point, forces()); }
  /// [N] The largest force of a contact, at least 1 N; NaN where a force is NaN.
  [[nodiscard]] double largest_force() const {
    double largest = larger_or_nan(1.0, tip.force.norm());
    for (const ShaftContact& contact : grips()) largest = larger_or_nan(largest, contact.force.norm());
    return largest;
  }
};

}  // namespace stylet
