// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "grip_matrix.hpp"

#include <utility>
#include <vector>

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
/// What is dear, the matrix of the shaft's contacts, is factorised by factorise() and used for as long as iterations
/// converge with it (GripMatrix). The tip, whose compliance changes with every cut and which may be held in none, one
/// or all of its directions, is added by a border of three rows each time. Three rows a contact, the tip first; LPS but
/// for `shift` and `lambda`, which are in the contacts' frames (n1, n2, t). Sized once; nothing allocates after that.
class ContactSystem {
 public:
  /// What of the tip is held.
  enum class TipRows { none, axial, all };

  /// @param contacts most contacts, tip included
  explicit ContactSystem(int contacts);

  int count = 0;                   ///< contacts, tip included
  MatX A;                          ///< [mm/N] tissue's compliance, full
  MatX N;                          ///< [mm/N] needle's compliance, full
  VecX free;                       ///< [mm]
  VecX now;                        ///< [N] λ_now
  VecX gap;                        ///< [mm] X + A λ_now − r_now: how far the tissue's points are beyond the needle's
  VecX shift;                      ///< [mm] in the frames
  std::vector<Mat3> frame;         ///< columns n1, n2, t of each contact
  std::vector<Yield> yield;        ///< D
  std::vector<LentSpring> spring;  ///< at the tip in all directions: `along` is zero
  bool supported = false;          ///< springs are lent

  // A cut goes on by so much as the tip's axial force says, which takes the tip to where the tissue's compliance is
  // another one: all gaps change.
  VecX drift;              ///< [mm/mm] by how much the gaps change as the cut goes on, beyond what D says of it
  double cut_per_N = 0.0;  ///< [mm/N] by which the cut goes on with the tip's axial force; 0: it does not
  double cut_due = 0.0;    ///< [mm] by which it is behind λ_now

  // A tip that is held along the needle only: its direction, and so its force, turns as the needle does, by so much as
  // the tip moves aside of a contact behind it, over the way between them.
  int behind = 0;          ///< that contact; 0 = none, the direction stays
  double behind_mm = 0.0;  ///< [mm] along the shaft

  VecX lambda;  ///< [N] contact forces on the tissue, in the frames
  VecX push;    ///< [N] p

  /// Takes A, N, D and the springs of now into the matrix. False where it is found singular; solve() may still find it.
  [[nodiscard]] bool factorise();

  /// Adds the contact after those in the matrix, with A, N and D of now; no spring is lent at it. False where the
  /// matrix must be made anew.
  [[nodiscard]] bool append();

  /// The first `contacts` of those in the matrix are all there are now. False where it must be made anew.
  [[nodiscard]] bool keep_first(int contacts);

  /// The needle's part of the equations for steps to come, made beside the one in use.
  struct Prepared {
    int count = 0;  ///< contacts, the first of those there
    MatX N;
    std::vector<LentSpring> spring;
    bool supported = false;
  };
  Prepared prepared;
  /// The matrix of that, with A and D of now, and then its factor. False where it is singular.
  void fill_prepared();
  [[nodiscard]] bool factorise_prepared();
  /// Both are in use from now on.
  void take_prepared();

  /// Adds the tip with A and N as they are now: good for as long as neither the tip nor the matrix changes much.
  void add_tip();

  /// λ and p for D, shift and gap of now. False where the matrix is singular.
  [[nodiscard]] bool solve(TipRows held);

  /// X + A λ_now − r_now + D λ_now − shift of a contact [mm], in its frame.
  [[nodiscard]] Vec3 error(int contact) const;

  /// How far a contact gives way to its own unit force along each direction of its frame [mm/N].
  [[nodiscard]] Vec3 own_yield(int contact) const;

  /// By how much the last solution takes a contact of the shaft to give way along t beyond what D of now says [mm]: the
  /// matrix is an older one. Where D is large, a sliding contact without viscosity, its force cannot tell how far it
  /// slides; with this it can.
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

  [[nodiscard]] bool drifts() const { return cut_per_N > 0.0; }
  [[nodiscard]] bool lends_at_tip() const { return supported && spring.front().stiffness > 0.0; }
  [[nodiscard]] bool turns(TipRows held) const { return held == TipRows::axial && behind > 0; }
  [[nodiscard]] Eigen::Index rows() const { return 3 * static_cast<Eigen::Index>(count); }
  [[nodiscard]] Eigen::Index grip_rows() const { return rows() - 3; }
  [[nodiscard]] std::span<const Yield> grip_yields() const { return std::span(yield).subspan(1, grip_count()); }
  [[nodiscard]] std::size_t grip_count() const { return static_cast<std::size_t>(count - 1); }
  [[nodiscard]] std::span<const LentSpring> grip_springs() const {
    return supported ? std::span(spring).subspan(1, grip_count()) : std::span<const LentSpring>();
  }

  GripMatrix grips_;
  GripMatrix prepared_grips_;
  bool lacks_tip_ = true;
  std::uint64_t solved_for_ = 0;  ///< version of the matrix that solved_ is of
  /// Columns beside B, solved in one go: of a force of the tip's spring, of a push at the tip, …
  static constexpr Eigen::Index kSpring = 0;
  static constexpr Eigen::Index kTip = 3;
  static constexpr Eigen::Index kRight = 6;  ///< … the right-hand side, …
  static constexpr Eigen::Index kDrift = 7;  ///< … and the drift
  MatX column_;                              ///< (rows × 6) those of the tip; kTip's are its rows, too
  MatX begun_;                               ///< (rows × 6) the same, half solved
  MatX solved_;                              ///< (rows × 8) B⁻¹ of all
  MatX beyond_;                              ///< (rows × 3) N's columns of the tip, less those of the contact behind
  VecX work_;
};

}  // namespace stylet
