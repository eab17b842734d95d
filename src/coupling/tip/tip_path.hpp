// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/marks.hpp"
#include "coupling/tip/tip_contact.hpp"
#include "coupling/tip/tip_events.hpp"
#include "coupling/tip/tracks.hpp"
#include "stylet/coupling/compliance_supply.hpp"

#include <optional>

namespace stylet {

/// The path of the tip: through the air, onto surfaces and through them, and along the track that it cuts or returns
/// through. This class decides what the tip meets; the balance decides the forces and the motion there.
class TipPath {
 public:
  /// All arguments outlive the path. @param base pose of the needle's base as the hand gives it
  TipPath(const InsertionTissue& mesh, const CouplingSettings& settings, const Pose& base, const Needle& needle,
          TissueResponse& tissue);

  TipContact tip;
  Tracks tracks;
  Marks marks;
  TipEvents events;

  [[nodiscard]] TipState phase() const { return phase_; }
  [[nodiscard]] bool in_air() const { return phase_ == TipState::air; }
  /// Whether the tip is outside the tissue by its state.
  [[nodiscard]] bool is_outside() const { return phase_ == TipState::air || phase_ == TipState::exited; }

  /// Places the tip in the air at the needle's tip, without contact on its way.
  void place_in_air(const Vec3& tip_now);
  /// Moves the tip through the air to the needle's tip, and tests whether it meets the patient's surface. Where it
  /// does, but the compliance there is missing, the tip waits to enter. If it is too far inside by the time the
  /// compliance arrives, it has to be drawn out first: the tissue was not moved along with the needle, and to press on
  /// it at this depth would be a blow.
  /// @return false where the tip waits
  bool move_through_air(Step& step) { return meet_surface(air_tip_, tip_now(), step); }
  /// Whether the tip has slid off the patient's surface, so that the needle lies on it and is in the tissue only as it
  /// is drawn, straight. No force acts on it until it is drawn out.
  [[nodiscard]] bool lies_on_surface() const { return slid_off_; }
  /// Sets the place of the tip in the air.
  void arrive(const Vec3& x) { air_tip_ = x; }
  [[nodiscard]] Vec3 tip_now() const { return needle_.point(needle_.length()); }

  /// Breaks the surface ahead and continues the cut behind it. @param hand_N axial force of the hand at that moment
  void break_surface(double hand_N, Step& step);
  /// A balance is found with the tip held at the end of a leg. The cut goes on from there along another direction,
  /// unless the force would not have cut so far; then it has to end within the leg. @return whether it goes on
  bool end_leg(double h, const ContactForces& forces);
  /// Updates the track after a sub-step's balance: it grows by the length of the cut. A surface that the cut has met
  /// becomes a membrane, bone, or the exit.
  void commit(Step& step);
  /// Handles the end of an open track at the far surface: behind that end the tip is in the track, beyond it in the
  /// air.
  void pass_open_end(const ContactForces& forces, Step& step);

  /// Whether the tip has come back out of the tissue, or was moved sideways out of the mouth of its track. To be called
  /// only without shaft contacts. @param drawn_out whether the base moves back along the needle
  [[nodiscard]] bool has_left(bool drawn_out) const;
  /// The hand takes up this needle, which was at rest: the tissue's compliance is that of its tip again.
  void take_up();

  /// Ends the insertion; its track becomes an earlier track.
  void finish();
  /// Places the needle, which is straight again, in the air where it has come out.
  void come_out();

  /// Whether a point [mm] LPS is inside the undeformed tissue; a point on its surface is not.
  [[nodiscard]] bool in_tissue(const Vec3& x) const;
  /// Place where the tip needs compliance next.
  [[nodiscard]] NeedleWhereabouts whereabouts() const;
  [[nodiscard]] bool awaits_entry() const { return awaited_entry_.has_value(); }
  void forget_entry();

 private:
  bool meet_surface(const Vec3& from, const Vec3& to, Step& step);
  void touch_surface(const Crossing& crossing, const Vec3& x, EventKind kind);
  void grow_track(const Cut::Place& from, const Cut::Place& to, Step& step);
  [[nodiscard]] Vec3 inwards_of(Index here, Index behind) const;
  void cross_surface();
  void slide_off_where_flat();
  [[nodiscard]] std::optional<Vec3> surface_behind(const Vec3& x) const;
  [[nodiscard]] const RegionLaws& laws(int region) const { return mesh_.laws[static_cast<std::size_t>(region)]; }
  [[nodiscard]] Vec3 tangent() const { return needle_.tangent(needle_.length()); }

  const InsertionTissue& mesh_;
  const CouplingSettings& settings_;
  const Needle& needle_;
  TissueResponse& tissue_;
  TipState phase_ = TipState::air;
  Vec3 air_tip_ = Vec3::Zero();                     ///< [mm] LPS, undeformed: last place of the tip in the air
  std::optional<NeedleWhereabouts> awaited_entry_;  ///< place on a surface that the tip has met, and where compliance
                                                    ///< is missing
  double entry_N_ = 0.0;                  ///< force at which the surface breaks that the tip touched from outside
  Vec3 entry_direction_ = Vec3::UnitZ();  ///< of the needle there, LPS
  bool slid_off_ = false;                 ///< lies_on_surface()
  bool went_past_surface_ = false;  ///< whether the tip is too far behind that surface and has to be drawn out first
};

}  // namespace stylet
