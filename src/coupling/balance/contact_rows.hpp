// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "coupling/balance/grip_matrix.hpp"

#include <vector>

namespace stylet {

/// Terms of the equations by which the tip's own motion enters.
struct TipMotion {
  /// [mm/mm] (3 contacts) Change of the gaps per length of cut, beyond the tip's own yield, because the tissue has
  /// another compliance at the new place of the tip.
  VecX drift;
  double cut_per_N = 0.0;  ///< [mm/N] length of cut per axial force of the tip; 0: the tip does not cut
  double cut_due = 0.0;    ///< [mm] length by which the cut is behind the present force
  /// Number of a contact behind the tip; 0: none. Where the tip is held along the needle only, its force turns with the
  /// needle's direction: by the lateral motion of the tip relative to this contact, over the distance between them.
  /// Without such a contact the direction is kept.
  int behind = 0;
  double behind_mm = 0.0;  ///< [mm] that distance along the shaft

  [[nodiscard]] bool drifts() const { return cut_per_N > 0.0; }
};

/// The rows of the contact equations, three for each contact, the tip first: the places of needle and tissue at each
/// contact, the contact's own yield in its present state, and its force. Nothing allocates after construction.
class ContactRows {
 public:
  /// @param most largest number of contacts, tip included
  ContactRows(const CouplingSettings& settings, int most);

  std::vector<Mat3> frame;   ///< columns n1, n2 (lateral) and t (along the needle) of each contact, LPS
  std::vector<Yield> yield;  ///< D: the own yield of each contact
  VecX shift;                ///< [mm] in the contacts' frames: term of the right-hand side that belongs to D
  VecX now;                  ///< [N] LPS, λ_now: the present forces on the tissue
  VecX gap;                  ///< [mm] LPS, position of the tissue point minus that of the needle point, under the
                             ///< present forces
  TipMotion tip;

  /// Error of a contact's equations at the present forces [mm], in its frame: gap + D λ_now − shift.
  [[nodiscard]] Vec3 error(int contact) const {
    const auto c = static_cast<std::size_t>(contact);
    const Vec3 off = gap.segment<3>(3 * contact) + yield[c].of(now.segment<3>(3 * contact));
    return frame[c].transpose() * off - shift.segment<3>(3 * contact);
  }

  /// Updates the geometry at all contacts: the frames, the needle's points, and the displacement of the tissue by
  /// earlier forces.
  void take_places(const Contacts& contacts);
  /// Updates the loads on the needle from the present forces.
  void take_loads(const Contacts& contacts);
  [[nodiscard]] std::span<PointLoad> loads() { return loads_; }
  [[nodiscard]] std::span<const PointLoad> loads() const { return loads_; }
  /// [N] The largest load, at least 1 N.
  [[nodiscard]] double largest_load() const;
  /// [N] The error that a balance may have.
  [[nodiscard]] double allowed() const { return settings_.tolerance * largest_load(); }

  /// Updates the yield D of each contact and its shift for a sub-step of h seconds, in the contact's present state.
  /// Also updates the friction terms `coulomb`, `slip` and `reach` of each shaft contact.
  void soften(const Contacts& contacts, double h);

  /// [mm] LPS, the needle's point at a contact, extended straight beyond the needle's ends; as of take_places().
  [[nodiscard]] const Vec3& needle_at(int load) const { return needle_[static_cast<std::size_t>(load)]; }
  /// [mm] LPS, position of a contact's tissue point without the present forces.
  [[nodiscard]] Vec3 unloaded(const Contacts& contacts, int load) const {
    return contacts.material(load) + past_[static_cast<std::size_t>(load)];
  }

 private:
  void soften_tip(const Contacts& contacts, double h);
  void soften_shaft(ShaftContact& contact, int load, double h);

  const CouplingSettings& settings_;
  std::vector<PointLoad> loads_;  ///< the loads on the needle, tip first: minus the forces on the tissue
  std::vector<Vec3> needle_;      ///< [mm] LPS
  std::vector<Vec3> past_;        ///< [mm] LPS, displacement of the tissue by earlier forces
};

}  // namespace stylet
