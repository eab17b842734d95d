// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contact_rows.hpp"
#include "coupling/balance/held_tissue.hpp"
#include "coupling/balance/needle_side.hpp"

#include <cstdint>

namespace stylet {

/// The contacts of the needles at rest, eliminated from the equations of ContactSystem. What is left is the system of
/// the needle that the hand moves, in a tissue that the needles at rest hold: with another compliance, other gaps and
/// another drift.
///
/// With the matrix B of the contacts at rest (RestingMatrix, SlidingRows), the changes z = (π, f) of their pushes and
/// of the forces of springs lent to their needles, the changes Δ of the forces on the moved needle's contacts (the
/// "others"), the length c of the cut, and S = (I, E),
///   B z = (free − error, −Eᵀ error) − Sᵀ A_ro Δ − Sᵀ drift c,
/// and the others are moved by A_or S z. So the others see the compliance A_oo − A_or S B⁻¹ Sᵀ A_ro (HeldTissue).
/// docs/theory/several_needles.md derives it.
///
/// Contacts are numbered like those of Contacts: the tip, those at rest, those of the moved needle. Vectors of the
/// others have three rows for each, the tip first, in LPS. Nothing allocates after construction.
class RestingGrips {
 public:
  /// @param grips number of contacts at rest, which does not change
  /// @param most_others largest number of contacts of the moved needle, its tip included
  RestingGrips(const ContactRows& rows, int grips, int most_others);

  [[nodiscard]] bool are_any() const { return count() > 0; }
  [[nodiscard]] int count() const { return matrix_.count(); }
  /// Marks B as outdated, because compliances have changed.
  void outdate() { matrix_.outdate(); }
  /// Whether errors at rest are solved for however small they are; otherwise those that hardly move a force are left.
  void solve_all(bool all) { solves_all_ = all; }
  /// Marks the tip's columns as outdated, because it has moved.
  void move_tip() { tip_is_new_ = true; }

  /// Whether D has changed such that follow() would change something.
  [[nodiscard]] bool differs() const { return !matrix_.fits() || sliding_.differs(yields(), matrix_); }
  /// Follows the present D, without a new B. @return whether what the others see belongs to it and to B
  [[nodiscard]] bool follow();
  /// The same, with a new B where that is necessary, and takes the contacts of `side` that are new.
  /// @param A [mm/N] compliance of the tissue among all contacts @return false where B is singular
  [[nodiscard]] bool fit(const MatX& A, const NeedleSide& side);
  /// Takes the contacts of `side` that are new, and updates what the others see.
  void take_contacts(const MatX& A, const NeedleSide& side);
  /// Removes all of the moved needle's contacts but the first, its tip included.
  void keep_first(int contacts) { held_.keep_first(contacts); }
  /// Counts the changes of what the others see.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  /// Solves for the contacts at rest with unchanged forces on the others. Updates the tip's part of what the others
  /// see.
  void solve(const MatX& A, const NeedleSide& side);
  /// Compliance of the held tissue among the others [mm/N].
  [[nodiscard]] const MatX& compliance() const { return compliance_; }
  /// Displacement of one of the others by the contacts at rest [mm], with unchanged forces on the others.
  [[nodiscard]] Vec3 moved(int other) const { return moved_.segment<3>(3 * other); }
  /// Subtracts the motion by the contacts at rest from the drift of the others [mm/mm].
  void correct_drift(Eigen::Ref<VecX> drift);

  /// The solution at rest. @param others [N] changes Δ of the forces on the others @param cut [mm] length c of the cut
  /// @param push, force [N] the changes are added to the rows of the contacts at rest
  void finish(const Eigen::Ref<const VecX>& others, double cut, VecX& push, Eigen::Ref<VecX> force);

  /// The solution with unchanged forces on the others; solve() before. @param push, force as in finish()
  void settle(VecX& push, Eigen::Ref<VecX> force);

  // The parts of the equations, for needles at rest that follow the moved one (RestingHold).
  [[nodiscard]] RestingMatrix& matrix() { return matrix_; }
  [[nodiscard]] const RestingMatrix& matrix() const { return matrix_; }
  [[nodiscard]] SlidingRows& sliding() { return sliding_; }
  [[nodiscard]] const SlidingRows& sliding() const { return sliding_; }
  [[nodiscard]] HeldTissue& held() { return held_; }
  [[nodiscard]] const HeldTissue& held() const { return held_; }

  /// D in the equations of a contact at rest. @param grip 0: the first one at rest
  [[nodiscard]] Yield yield(int grip) const;

 private:
  [[nodiscard]] std::span<const Yield> yields() const {
    return std::span(rows_.yield).subspan(1, static_cast<std::size_t>(count()));
  }
  /// Rows of the moved needle's shaft contacts start here.
  [[nodiscard]] Eigen::Index first_own() const { return 3 + matrix_.contact_rows(); }
  void add_tip_of(const MatX& A);
  [[nodiscard]] bool right_side(const NeedleSide& side);

  const ContactRows& rows_;
  RestingMatrix matrix_;
  SlidingRows sliding_;
  HeldTissue held_;
  std::uint64_t version_ = 0;
  bool solves_all_ = false;
  bool tip_is_new_ = true;  ///< whether the tip's columns have to be solved
  bool moves_ = false;      ///< whether still_ is not zero
  MatX compliance_;         ///< (3 others × 3 others)
  VecX moved_;              ///< (3 others)
  MatX columns_;            ///< (rows, or 3 others, × GripMatrix::kMostColumns) work space
  VecX z_;                  ///< (rows) right-hand side, or work space
  VecX given_;              ///< (rows) right-hand side that still_ was solved for
  VecX still_;              ///< (rows) B⁻¹ of it
  VecX drift_;              ///< (rows) B⁻¹ Sᵀ drift
};

}  // namespace stylet
