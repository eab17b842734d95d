// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/tip/cut.hpp"
#include "coupling/tip/cutting_law.hpp"
#include "coupling/tip/resistance.hpp"
#include "stylet/needle/needle.hpp"

namespace stylet {

/// The needle's tip against the end of its track: whether it is held there, cuts on, or has come away from it.
class TipContact {
 public:
  enum class State { open, stick, cut };

  /// All outlive the contact. @param base pose of the needle's base as the hand gives it: which way the bevel looks
  TipContact(const CouplingSettings& settings, const Locator& locator, const Pose& base, const Needle& needle,
             TissueResponse& tissue)
      : cut(locator, tissue),
        settings_(settings),
        base_(base),
        needle_(needle),
        tissue_(tissue),
        viscosity_(settings.tip_viscosity_Ns_per_mm) {}

  Cut cut;
  Resistance ahead;
  Vec3 force = Vec3::Zero();  ///< [N] LPS, on the tissue
  ForceHistory history;
  int toggles = 0;            ///< changes of state in this sub-step
  double cut_mm_per_s = 0.0;  ///< [mm/s] speed of cutting in the last sub-step, for a program's own law

  /// Whether there is an end of a track to push against.
  [[nodiscard]] bool touches() const { return touches_; }
  [[nodiscard]] State state() const { return state_; }
  /// Whether what is ahead of the tip acts on it.
  [[nodiscard]] bool holds() const { return touches_ && state_ != State::open; }
  [[nodiscard]] bool cuts() const { return touches_ && state_ == State::cut; }
  [[nodiscard]] bool is_on_bone() const { return touches_ && state_ == State::stick && ahead.is_bone(); }
  /// The law of a tip that cuts here, in a sub-step of h seconds.
  [[nodiscard]] CuttingLaw cutting_law(double h) const;
  /// Asks a program's own law of cutting, if there is one, what resists the tip from here on.
  void ask_own_law();
  /// Whether that law gave numbers that cannot be used, so that the built-in law stands in for it.
  [[nodiscard]] bool refuses_own_law() const { return refuses_own_law_; }
  /// Whether it waits for compliance that is not there yet.
  [[nodiscard]] bool waits() const { return touches_ && cut.is_stale(); }

  /// The tip is put to the end of a track: x [mm] LPS, undeformed, in the element of `at`. @param touches whether there
  /// is tissue ahead @param state what the tip does there
  void put(const Vec3& x, const MaterialPoint& at, bool touches, State state);
  /// The needle is out of the tissue.
  void forget();
  /// The tip comes out of the tissue at the far side.
  void exit();
  void set_state(State state) { state_ = state; }

  /// A sub-step's balance begins: remembers where the tip is, and aims the cut.
  void begin(const ContactForces& forces);
  /// Whether the surface ahead bears less than the present force. To be asked of a balance only: a broken surface does
  /// not heal, and the forces of an iterate on the way to a balance are not forces on the tissue.
  [[nodiscard]] bool breaks_surface() const;
  /// The tip goes back to where the sub-step, or the cut behind a surface that broke in it, began.
  void take_back_cut();

  /// The shaft has taken over a share of the tip's lateral hold, 0…1.
  void hand_over(double share);
  /// [mm/N] Softness of the lateral hold; infinite once the shaft has taken it over.
  [[nodiscard]] double lateral_hold() const { return lateral_hold_; }
  /// Whether the balance has equations for lateral forces at the tip.
  [[nodiscard]] bool has_lateral_rows() const;
  /// [mm/N] Softness of these equations.
  [[nodiscard]] double lateral_softness() const;
  /// [N] LPS, force on the tissue of a bevel that is pushed sideways.
  [[nodiscard]] Vec3 bevel_force() const;

 private:
  void aim(const ContactForces& forces);
  [[nodiscard]] Vec3 lead_of_bevel(const Vec3& tangent) const;
  [[nodiscard]] Vec3 tangent() const { return needle_.tangent(needle_.length()); }

  const CouplingSettings& settings_;
  const Pose& base_;
  const Needle& needle_;
  TissueResponse& tissue_;
  State state_ = State::open;
  bool touches_ = false;
  double lateral_hold_ = 0.0;
  double viscosity_;  ///< [N s/mm] of the law of cutting
  bool refuses_own_law_ = false;
};

}  // namespace stylet
