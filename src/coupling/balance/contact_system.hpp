// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contact_rows.hpp"
#include "coupling/balance/grip_columns.hpp"
#include "coupling/balance/resting_grips.hpp"

#include <utility>

namespace stylet {

/// The linear equations of one iteration, with contact forces λ on the tissue and pushes p on the needle, whose loads
/// are −p. Tissue, needle and contacts:
///   u = A λ,   r = r_now + free − N π,   π = p − λ_now,   λ = p + E f,   X + u − r + D λ = shift.
/// f = K Eᵀ (r − r_now) are the forces of springs K that are lent to a needle which would buckle by itself
/// (Needle::linearise); they belong to the contacts. Without springs f is empty. With error = X + A λ_now − r_now + D
/// λ_now − shift and P = A + diag(D), the rows of held contacts and of springs become
///   (P + N) π + P E f = free − error,   Eᵀ P π + (Eᵀ P E − K⁻¹) f = −Eᵀ error.
/// docs/theory/coupling.md §4 derives them.
///
/// The matrix of the shaft contacts takes most of the time. factorise() factorises it, and it is used for as long as
/// iterations converge with it (GripMatrix). The tip is a border of three rows that is added each time, because its
/// compliance changes with every cut, and because it may be held in none, one or all of its directions. There are three
/// rows for each contact, in the order of Contacts. Vectors are in LPS; ContactRows::shift and `lambda` are in the
/// contacts' frames (n1, n2, t). Nothing allocates after construction.
///
/// The contacts of needles at rest are eliminated first (RestingGrips). The matrix of the shaft contacts, their columns
/// and the tip then belong to the moved needle alone, in the tissue that the others hold.
class ContactSystem {
 public:
  /// The directions in which the tip is held.
  enum class TipRows { none, axial, all };

  /// @param rows of the contacts; outlives the system @param most largest number of contacts, tip included
  /// @param at_rest number of contacts of needles at rest
  ContactSystem(const ContactRows& rows, int most, int at_rest);

  MatX A;               ///< [mm/N] compliance of the tissue, both triangles
  NeedleSide needle;    ///< the needle's side of the equations
  NeedleSide prepared;  ///< the needle's side for later steps, built beside the present one; its contacts are the first
                        ///< present contacts

  VecX lambda;  ///< [N] contact forces on the tissue, in the contacts' frames
  VecX push;    ///< [N] pushes p on the needle

  /// Whether the matrix belongs to the present contacts, with an N and an A that are close enough. If not, factorise()
  /// has to be called.
  [[nodiscard]] bool fits() const { return fits_; }
  /// Marks the matrix as outdated: the moved needle's N has changed too much.
  void outdate() { fits_ = false; }
  /// The same where A, the contacts or the N of needles at rest have changed.
  void outdate_all() {
    fits_ = false;
    resting_.outdate();
  }

  /// Factorises the matrix with the present A, N, D and springs. @return false where it is found singular, although a
  /// later solve() may still succeed
  bool factorise();

  /// Appends the contact that was added to the needle's side to a matrix that fits, with the present A, N and D.
  /// @return whether the matrix still fits
  bool append();

  /// Removes all contacts but the first `contacts`. @return whether the matrix fits the remaining ones
  bool keep_first(int contacts);

  /// Fills the matrix of the prepared needle's side, with the present A and D.
  void fill_prepared();
  /// Factorises that matrix. @return false where it is singular
  [[nodiscard]] bool factorise_prepared();
  /// Puts the prepared needle's side and its factor in the place of the present ones.
  void take_prepared();

  /// Whether errors of needles at rest are solved for however small they are (RestingGrips).
  void solve_all_at_rest(bool all) { resting_.solve_all(all); }

  /// Solves for the contacts at rest alone, with unchanged forces on the moved needle. Their `push` and `lambda` are
  /// written. @return false where their matrix is outdated
  [[nodiscard]] bool settle_rest();
  [[nodiscard]] RestingGrips& resting() { return resting_; }

  /// Adds the tip with the present A and N in the next solve(). Valid as long as neither the tip nor the matrix changes
  /// much.
  void add_tip();

  /// Computes λ and p for the present D, shift and gap. @return false where the matrix is singular
  [[nodiscard]] bool solve(TipRows held);

  /// Displacement of a contact by its own unit force along each direction of its frame [mm/N].
  [[nodiscard]] Vec3 own_yield(int contact) const;

  /// Displacement of a shaft contact along t in the last solution, beyond what the present D gives [mm]; not zero where
  /// the matrix has an older D. Where D is large, at a sliding contact without viscosity, the force does not determine
  /// how far the contact slides, and this does.
  [[nodiscard]] double axial_excess(int contact) const;

  /// (r − X − A λ)·t of the tip in the last solution: how far the needle is beyond the tissue if the tip is not held
  /// [mm].
  [[nodiscard]] double opening() const;

 private:
  /// A quantity that depends on the tip's π_0: at − per π_0.
  struct Along {
    Vec3 at = Vec3::Zero();
    Mat3 per = Mat3::Zero();
  };

  [[nodiscard]] bool solve_grips();
  [[nodiscard]] std::pair<Vec3, Vec3> solve_tip(TipRows held);
  [[nodiscard]] Mat3 subtract_grips(const Eigen::Ref<const MatX>& columns, Along& moves) const;

  [[nodiscard]] bool turns(TipRows held) const { return held == TipRows::axial && rows_.tip.behind > 0; }
  /// Rows of the moved needle's shaft contacts, and the first of them among all rows.
  [[nodiscard]] Eigen::Index grip_rows() const { return needle.rows() - first_row(); }
  [[nodiscard]] Eigen::Index first_row() const { return 3 * static_cast<Eigen::Index>(first_grip()); }
  /// Number of the first shaft contact of the moved needle.
  [[nodiscard]] std::size_t first_grip() const { return 1 + static_cast<std::size_t>(resting_.count()); }
  /// Number of a contact of the moved needle among all contacts. @param own 0: its tip
  [[nodiscard]] int load(int own) const { return own == 0 ? 0 : own + resting_.count(); }
  [[nodiscard]] std::span<const Yield> yields_of(const NeedleSide& side) const {
    return std::span(rows_.yield).subspan(first_grip(), static_cast<std::size_t>(side.count) - first_grip());
  }
  [[nodiscard]] std::span<const LentSpring> springs_of(const NeedleSide& side) const {
    const auto all = side.shaft_springs();
    return all.empty() ? all : all.subspan(first_grip() - 1);
  }
  /// The compliance of the tissue for the moved needle's contacts, its tip first.
  [[nodiscard]] const MatX& seen() const { return resting_.are_any() ? resting_.compliance() : A; }
  /// Error of a contact of the moved needle, in its frame [mm], with unchanged forces on the moved needle.
  [[nodiscard]] Vec3 error(int own) const {
    const int c = load(own);
    return rows_.error(c) + rows_.frame[static_cast<std::size_t>(c)].transpose() * resting_.moved(own);
  }

  const ContactRows& rows_;
  bool fits_ = false;
  GripMatrix grips_;
  GripMatrix prepared_grips_;
  GripColumns columns_;
  RestingGrips resting_;
  VecX drift_;   ///< [mm/mm] (rows) drift of the moved needle's contacts
  VecX others_;  ///< [N] (rows) work space: changes of the forces on the moved needle's contacts
  MatX beyond_;  ///< (rows × 3) work space: N's columns of the tip minus those of the contact behind it
  VecX work_;    ///< (rows) work space
};

}  // namespace stylet
