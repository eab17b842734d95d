// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "coupling/balance/grip_matrix.hpp"

#include <vector>

namespace stylet {

/// How the tip's own motion changes the equations.
struct TipMotion {
  /// [mm/mm] (3 contacts) By how much the gaps change as the cut goes on, beyond what the tip's yield says of it: the
  /// cut takes the tip to where the tissue's compliance is another one.
  VecX drift;
  double cut_per_N = 0.0;  ///< [mm/N] way that the cut goes on with the tip's axial force; 0: it does not
  double cut_due = 0.0;    ///< [mm] by which the cut is behind the present force
  /// A tip that is held along the needle only: its direction, and so its force, turns as the needle does, by so much as
  /// the tip moves aside of a contact behind it, over the way between them. 0 = no such contact, the direction stays.
  int behind = 0;
  double behind_mm = 0.0;  ///< [mm] that way, along the shaft

  [[nodiscard]] bool drifts() const { return cut_per_N > 0.0; }
};

/// The rows of the contact equations, three a contact, the tip first: where needle and tissue are at each contact, what
/// each contact yields by itself in its present state, and its force. Nothing allocates after construction.
class ContactRows {
 public:
  /// @param most contacts, tip included
  ContactRows(const CouplingSettings& settings, int most);

  std::vector<Mat3> frame;   ///< columns n1, n2, t of each contact: across the needle and along it, LPS
  std::vector<Yield> yield;  ///< D: what each contact gives way by itself
  VecX shift;                ///< [mm] in the frames: what that adds to the right-hand side
  VecX now;                  ///< [N] LPS, λ_now: the present forces on the tissue
  VecX gap;                  ///< [mm] LPS, how far the tissue's points are beyond the needle's under these forces
  TipMotion tip;

  /// By how much a contact's equations are not fulfilled at the present forces [mm], in its frame: gap + D λ_now −
  /// shift.
  [[nodiscard]] Vec3 error(int contact) const {
    const auto c = static_cast<std::size_t>(contact);
    const Vec3 off = gap.segment<3>(3 * contact) + yield[c].of(now.segment<3>(3 * contact));
    return frame[c].transpose() * off - shift.segment<3>(3 * contact);
  }

  /// Takes the places of all contacts: their frames, the needle's points there, and what earlier forces do to the
  /// tissue.
  void take_places(const Contacts& contacts);
  /// The loads on the needle under the present forces.
  void take_loads(const Contacts& contacts);
  [[nodiscard]] std::span<PointLoad> loads() { return loads_; }
  [[nodiscard]] std::span<const PointLoad> loads() const { return loads_; }
  /// [N] Largest of the loads, at least 1.
  [[nodiscard]] double largest_load() const;

  /// Writes the yield of each contact in a sub-step of h seconds, in the contact's present state, and the shift that
  /// this state adds to the right-hand side; and in each contact of the shaft the numbers of its friction: `coulomb`,
  /// `slip` and `reach`.
  /// @param foresees_cut whether the equations know that compliance changes as the cut goes on
  void soften(const Contacts& contacts, double h, bool foresees_cut);

  /// [mm] LPS, the needle at a contact, straight on past its ends; as of take_places().
  [[nodiscard]] const Vec3& needle_at(int load) const { return needle_[static_cast<std::size_t>(load)]; }
  /// [mm] LPS, where the tissue at a contact would be without the present forces.
  [[nodiscard]] Vec3 unloaded(const Contacts& contacts, int load) const {
    return contacts.material(load) + past_[static_cast<std::size_t>(load)];
  }

 private:
  void soften_tip(const Contacts& contacts, double h, bool foresees_cut);
  void soften_shaft(ShaftContact& contact, int load, double h);

  const CouplingSettings& settings_;
  std::vector<PointLoad> loads_;  ///< tip first: minus the forces on the tissue
  std::vector<Vec3> needle_;      ///< [mm] LPS
  std::vector<Vec3> past_;        ///< [mm] LPS, displacement of the tissue by earlier forces
};

}  // namespace stylet
