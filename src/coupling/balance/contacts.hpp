// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/largest.hpp"
#include "coupling/contacts/shaft_contacts.hpp"
#include "coupling/tip/tip_contact.hpp"

#include <algorithm>

namespace stylet {

/// All contacts between a needle and tissue, numbered as the needle's loads are: 0 is the tip, 1 the shaft's first
/// contact. A view: it keeps nothing.
struct Contacts {
  Needle& needle;
  TissueResponse& tissue;
  TipContact& tip;
  ShaftContacts& shaft;

  [[nodiscard]] int count() const { return 1 + static_cast<int>(shaft.count()); }
  [[nodiscard]] ShaftContact& of_shaft(int load) const { return shaft.all()[static_cast<std::size_t>(load - 1)]; }
  /// Number of a contact's point in ContactCompliance.
  [[nodiscard]] int point(int load) const { return load == 0 ? ContactCompliance::kTip : of_shaft(load).point; }
  /// [N] LPS, on the tissue.
  [[nodiscard]] Vec3& force(int load) const { return load == 0 ? tip.force : of_shaft(load).force; }
  /// [mm] LPS, undeformed place of the tissue's point.
  [[nodiscard]] const Vec3& material(int load) const { return load == 0 ? tip.cut.x() : of_shaft(load).x; }
  /// [mm] Place along the needle, within its length.
  [[nodiscard]] double arc(int load) const {
    return load == 0 ? needle.length() : std::clamp(of_shaft(load).s, 0.0, needle.length());
  }
  [[nodiscard]] ContactForces forces() const { return {tip.force, shaft.all()}; }
  /// [mm] LPS, displacement of a point by all forces.
  [[nodiscard]] Vec3 displacement(int point) const { return tissue.displacement(point, forces()); }
  /// [N] of all contacts, at least 1; not a number where one is none.
  [[nodiscard]] double largest_force() const {
    double largest = larger_or_nan(1.0, tip.force.norm());
    for (const ShaftContact& contact : shaft.all()) largest = larger_or_nan(largest, contact.force.norm());
    return largest;
  }
};

}  // namespace stylet
