// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contact_rows.hpp"
#include "coupling/balance/grip_columns.hpp"

#include <utility>

namespace stylet {

/// The linear equations of one iteration: contact forces λ on the tissue and pushes p on the needle, whose loads are
/// −p. Tissue, needle, and contact c:
///   u = A λ,   r = r_now + free − N π,   π = p − λ_now,   λ = p + E f,   X + u − r + D λ = shift,
/// f being the forces of springs K lent across a needle that would buckle by itself, f = K Eᵀ (r − r_now), or nothing
/// (Needle::linearise): they belong to the contacts. With error = X + A λ_now − r_now + D λ_now − shift and P = A +
/// diag(D) the rows that are held, and those of the springs, become
///   (P + N) π + P E f = free − error,   Eᵀ P π + (Eᵀ P E − K⁻¹) f = −Eᵀ error.
/// docs/theory/coupling.md §4 derives them.
///
/// The matrix of the shaft's contacts takes most of the time. It is factorised by factorise() and used for as long as
/// iterations converge with it (GripMatrix). The tip, whose compliance changes with every cut and which may be held in
/// none, one or all of its directions, is added by a border of three rows each time. Three rows a contact, the tip
/// first; LPS but for ContactRows::shift and `lambda`, which are in the contacts' frames (n1, n2, t). Nothing allocates
/// after construction.
class ContactSystem {
 public:
  /// The directions in which the tip is held.
  enum class TipRows { none, axial, all };

  /// @param rows of the contacts; outlives the system @param most contacts, tip included
  ContactSystem(const ContactRows& rows, int most);

  MatX A;               ///< [mm/N] tissue's compliance, full
  NeedleSide needle;    ///< the needle's side of the equations
  NeedleSide prepared;  ///< the same for steps to come, made beside the one in use; its contacts are the first of those

  VecX lambda;  ///< [N] contact forces on the tissue, in the frames
  VecX push;    ///< [N] p

  /// Whether the matrix is of the present contacts, with an N and an A that are good enough; where not, it is to be
  /// made by factorise().
  [[nodiscard]] bool fits() const { return fits_; }
  /// N or A have changed by more than an old matrix is good for.
  void outdate() { fits_ = false; }

  /// Takes the present A, N, D and springs into the matrix. @return false where it is found singular; solve() may still
  /// find it
  bool factorise();

  /// The contact that was added to the needle's side goes into the matrix that fits, with the present A, N and D.
  /// @return whether the matrix fits with it
  bool append();

  /// The first `contacts` are all that are left. @return whether the matrix fits them
  bool keep_first(int contacts);

  /// Makes the matrix of the needle's side that is prepared, with the present A and D.
  void fill_prepared();
  /// Factorises that matrix. @return false where it is singular
  [[nodiscard]] bool factorise_prepared();
  /// The needle's side that is prepared and its factor are in use from now on.
  void take_prepared();

  /// Adds the tip with the present A and N: good for as long as neither the tip nor the matrix changes much.
  void add_tip();

  /// λ and p for the present D, shift and gap. False where the matrix is singular.
  [[nodiscard]] bool solve(TipRows held);

  /// How far a contact gives way to its own unit force along each direction of its frame [mm/N].
  [[nodiscard]] Vec3 own_yield(int contact) const;

  /// By how much the last solution takes a contact of the shaft to give way along t beyond what the present D says
  /// [mm]: the matrix is an older one. Where D is large, a sliding contact without viscosity, its force cannot tell how
  /// far it slides; with this it can.
  [[nodiscard]] double axial_excess(int contact) const;

  /// (r − X − A λ)·t of the tip in the last solution: how far the needle is beyond the tissue where it is not held
  /// [mm].
  [[nodiscard]] double opening() const;

 private:
  /// A quantity at − per π_0, π_0 being the tip's.
  struct Along {
    Vec3 at = Vec3::Zero();
    Mat3 per = Mat3::Zero();
  };

  [[nodiscard]] bool solve_grips();
  [[nodiscard]] std::pair<Vec3, Vec3> solve_tip(TipRows held);
  [[nodiscard]] Mat3 subtract_grips(const Eigen::Ref<const MatX>& columns, Along& moves) const;

  [[nodiscard]] bool turns(TipRows held) const { return held == TipRows::axial && rows_.tip.behind > 0; }
  [[nodiscard]] Eigen::Index grip_rows() const { return needle.rows() - 3; }
  [[nodiscard]] std::span<const Yield> yields_of(const NeedleSide& side) const {
    return std::span(rows_.yield).subspan(1, static_cast<std::size_t>(side.count - 1));
  }

  const ContactRows& rows_;
  bool fits_ = false;
  GripMatrix grips_;
  GripMatrix prepared_grips_;
  GripColumns columns_;
  MatX beyond_;  ///< (rows × 3) room: N's columns of the tip, less those of the contact behind
  VecX work_;    ///< (rows) room
};

}  // namespace stylet
