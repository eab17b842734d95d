// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/tip/cut.hpp"
#include "coupling/tip/cutting_law.hpp"
#include "coupling/tip/resistance.hpp"
#include "stylet/needle/needle.hpp"

namespace stylet {

/// The contact of the needle's tip with the end of its track: whether it is held there, cuts, or is open.
class TipContact {
 public:
  enum class State { open, stick, cut };

  /// All arguments outlive the contact. @param base pose of the needle's base as the hand gives it, for the bevel's
  /// direction
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

  /// Whether the tip is at the end of a track in tissue.
  [[nodiscard]] bool touches() const { return touches_; }
  [[nodiscard]] State state() const { return state_; }
  /// Whether the tissue ahead acts on the tip.
  [[nodiscard]] bool holds() const { return touches_ && state_ != State::open; }
  [[nodiscard]] bool cuts() const { return touches_ && state_ == State::cut; }
  [[nodiscard]] bool is_on_bone() const { return touches_ && state_ == State::stick && ahead.is_bone(); }
  /// The law of cutting at this place, in a sub-step of h seconds.
  [[nodiscard]] CuttingLaw cutting_law(double h) const;
  /// [mm] Length of cut under the present force.
  [[nodiscard]] double would_cut(double h) const { return cutting_law(h).way(force.dot(tangent())); }
  /// Asks a program's own law of cutting, if there is one, for the cutting force and viscosity from here on.
  void ask_own_law();
  /// Whether that law gave numbers that cannot be used, so that the built-in law stands in for it.
  [[nodiscard]] bool refuses_own_law() const { return refuses_own_law_; }
  /// Whether the tip waits for compliance that has not been computed yet.
  [[nodiscard]] bool waits() const { return touches_ && cut.is_stale(); }

  /// Places the tip at the end of a track: x [mm] LPS, undeformed, in the element of `at`.
  /// @param touches whether there is tissue ahead @param state state of the contact there
  void put(const Vec3& x, const MaterialPoint& at, bool touches, State state);
  /// Resets the contact: the needle is out of the tissue.
  void forget();
  /// Opens the contact: the tip leaves the tissue at the far side.
  void exit();
  void set_state(State state) { state_ = state; }

  /// Begins a sub-step's balance: stores the place of the tip, and aims the cut.
  void begin(const ContactForces& forces);
  /// Chooses the direction of the cut by the shape of the needle and by the deformation of the tissue at the tip.
  /// Behind a surface that breaks it is chosen anew: the tissue before the surface may be softer and have been
  /// squeezed.
  void aim(const ContactForces& forces);
  /// Whether the present force exceeds the strength of the surface ahead. To be called for a balance only: a broken
  /// surface does not heal, and the forces of an iterate are not yet forces on the tissue.
  [[nodiscard]] bool breaks_surface() const;
  /// Returns the tip to the start of the sub-step, or of the cut behind a surface that broke in this sub-step.
  void take_back_cut();

  /// Sets the share 0 … 1 of the tip's lateral hold that the shaft has taken over.
  void hand_over(double share);
  /// [mm/N] Softness of the lateral hold; infinite once the shaft has taken over all of it.
  [[nodiscard]] double lateral_hold() const { return lateral_hold_; }
  /// Whether the balance has equations for lateral forces at the tip.
  [[nodiscard]] bool has_lateral_rows() const;
  /// [mm/N] Softness of these equations.
  [[nodiscard]] double lateral_softness() const;
  /// [N] LPS, force on the tissue by a bevel of Law::force.
  [[nodiscard]] Vec3 bevel_force() const;

 private:
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
