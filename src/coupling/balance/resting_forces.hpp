// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/axial_forces.hpp"
#include "coupling/balance/contacts.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The forces on the contacts at rest while they follow the moved needle (RestingHold): those of a reference, and what
/// has changed since then by linear equations. With the changes Δ of the forces on the moved needle, and with solved
/// columns for what creeps, for the usual displacement by the tip (TipReach), and for each contact that slides,
///   z = z₀ + Z q,   z₀ = −W Δ + φ f − ε u − Σ_k e_k Z_k,   (diag(1/more) + Eᵀ Z) q = −Eᵀ z₀   (SlidingRows).
/// The forces are computed only where they are asked for. What the moved needle feels of all of them is kept in vectors
/// of the length of its own. Nothing allocates after construction.
class RestingForces {
 public:
  /// @param most_own largest number of contacts of the moved needle, its tip included
  RestingForces(int grips, int most_own);

  /// Whether there is a reference: if not, the contacts have their forces.
  [[nodiscard]] bool are_known() const { return known_; }
  /// Forgets the reference.
  void forget() { known_ = false; }
  /// The columns f and u (rows × 2), which are solved for at a look.
  [[nodiscard]] auto columns(const RestingMatrix& matrix) { return solved_.topRows(matrix.rows()); }

  /// Takes the present forces as the reference.
  /// @param frames of the contacts at rest, with the direction along the needle in the last column
  /// @param columns whether W or f and u are new @param own [N] (3 own) forces on the moved needle's contacts
  void take(bool columns, const Contacts& all, std::span<const Mat3> frames, RestingGrips& grips,
            const Eigen::Ref<const VecX>& own);
  /// [N] (3 grips) on the tissue
  [[nodiscard]] auto reference(const RestingMatrix& matrix) const { return force_.head(matrix.contact_rows()); }
  /// [N] (3 own) forces of the reference on the moved needle.
  [[nodiscard]] auto own(const HeldTissue& held) const { return own_.head(held.others()); }

  /// The tissue creeps on: f counts `part` times more from here on.
  void creep(double part) { creep_ += part; }
  /// u counts `part` times from here on.
  void set_usual(double part) { usual_ = part; }
  /// A contact at rest that slides begins at its present place, `mm` from where it was.
  void slide(int grip, double mm, RestingGrips& grips);
  /// Begins a sub-step: computes motion(). To be called after creep(), set_usual() and slide().
  void begin(const RestingGrips& grips);
  /// [mm] Displacement of a contact of the moved needle by the contacts at rest, for no force on it, but for that of
  /// the tip by the forces of the reference. @param row the contact's first row
  [[nodiscard]] Vec3 motion(Eigen::Index row) const { return motion_.segment<3>(row); }

  /// Prepares write(), and computes the forces along the needles. @param own [N] (3 own) present forces on the moved
  /// needle @return [N] (grips) a view of work space
  Eigen::Ref<const VecX> follow(const Eigen::Ref<const VecX>& own, RestingGrips& grips);
  /// Computes the forces on contacts at rest. @param first, end numbers from 0 on
  void compute(int first, int end, RestingGrips& grips);
  /// [N] (3 grips) a view of work space, which is right for contacts after compute().
  [[nodiscard]] Eigen::Ref<const VecX> computed(const RestingGrips& grips);

 private:
  void add_rows(Eigen::Index from, Eigen::Index count, RestingGrips& grips);

  bool known_ = false;
  VecX force_;              ///< [N] (3 grips) of the reference
  VecX own_;                ///< [N] (3 own) of the reference
  VecX change_;             ///< [N] (3 own) Δ
  MatX moved_;              ///< [mm] (3 own × 3) by the reference, by f, and Σ_k e_k Wᵀ E_k
  MatX solved_;             ///< (rows × 2) f and u
  MatX along_;              ///< (sliding × 4) Eᵀ f, Eᵀ u, Σ_k e_k Eᵀ Z_k, and q
  std::vector<int> slid_;   ///< contacts with an e_k
  std::vector<double> mm_;  ///< (grips) e_k
  double creep_ = 0.0;      ///< φ
  double usual_ = 0.0;      ///< ε
  AxialForces axial_;
  VecX motion_, z_, now_;  ///< work space
};

}  // namespace stylet
