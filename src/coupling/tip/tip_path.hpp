// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/marks.hpp"
#include "coupling/tip/tip_contact.hpp"
#include "coupling/tip/tracks.hpp"
#include "stylet/coupling/compliance_supply.hpp"

#include <array>
#include <limits>
#include <optional>
#include <span>

namespace stylet {

/// The tip on its way: through the air, onto surfaces and through them, along the track that it cuts or goes back
/// through. Decides what the tip meets; what the tip does there is the balance's to find.
class TipPath {
 public:
  /// All outlive the path. @param base pose of the needle's base as the hand gives it
  TipPath(const InsertionTissue& mesh, const CouplingSettings& settings, const Pose& base, const Needle& needle,
          TissueResponse& tissue);

  TipContact tip;
  Tracks tracks;
  Marks marks;

  [[nodiscard]] TipState phase() const { return phase_; }
  /// The events since they were last forgotten.
  [[nodiscard]] std::span<const InsertionEvent> events() const { return {event_.data(), event_count_}; }
  [[nodiscard]] static constexpr std::size_t most_events() { return kMostEvents; }
  void forget_events() { event_count_ = 0; }
  [[nodiscard]] bool in_air() const { return phase_ == TipState::air; }
  /// Whether the tip is outside the tissue, as far as the model knows.
  [[nodiscard]] bool is_outside() const { return phase_ == TipState::air || phase_ == TipState::exited; }

  /// A tip in the air is where the needle's tip is, without having touched anything on its way.
  void place_in_air(const Vec3& tip_now);
  /// The tip moved through the air to where the needle's tip is: does it meet the patient's surface? Where it does and
  /// no compliance is there, it has yet to enter, or, if it is far inside by the time there is some, to be drawn out:
  /// tissue that would have gone with it did not, and to press on it now would be a blow.
  /// @return false where it has yet to enter
  bool move_through_air(Step& step) { return meet_surface(air_tip_, tip_now(), step); }
  /// The tip has arrived there.
  void arrive(const Vec3& x) { air_tip_ = x; }
  [[nodiscard]] Vec3 tip_now() const { return needle_.point(needle_.length()); }

  /// The surface ahead breaks and the cut goes on behind it. @param hand_N axial force of the hand at that moment
  void break_surface(double hand_N, Step& step);
  /// After a sub-step's balance: the track grows by what was cut; a surface that was met becomes a membrane, a bone, or
  /// the way out.
  void commit(Step& step);
  /// The end of an open track is a hole in the far surface: behind it the tip is in the track, beyond it in the air.
  void pass_open_end(const ContactForces& forces, Step& step);

  /// Whether the tip has come back out of the tissue, or was moved out of the mouth of its track sideways, given that
  /// the needle holds no tissue. @param drawn_out the base moves back along the needle
  [[nodiscard]] bool has_left(bool drawn_out) const;
  /// The insertion is over: its track becomes an earlier one.
  void finish();
  /// The needle, straight again, is in the air where it has come out.
  void come_out();

  /// Whether a point [mm] LPS of the tissue at rest is inside of it; a tip at its surface is not.
  [[nodiscard]] bool in_tissue(const Vec3& x) const;
  /// Where compliance is needed next for the tip.
  [[nodiscard]] NeedleWhereabouts whereabouts() const;
  [[nodiscard]] bool awaits_entry() const { return awaited_entry_.has_value(); }
  void forget_entry();

 private:
  bool meet_surface(const Vec3& from, const Vec3& to, Step& step);
  void touch_surface(const Crossing& crossing, const Vec3& x, EventKind kind);
  void cross_surface();
  /// Remembers an event, unless there is no room for one more.
  /// @param force_N axial force of the hand when it happened; not a number where that says nothing
  void add_event(EventKind kind, int region, double force_N = std::numeric_limits<double>::quiet_NaN());
  [[nodiscard]] std::optional<Vec3> surface_behind(const Vec3& x) const;
  [[nodiscard]] const RegionLaws& laws(int region) const { return mesh_.laws[static_cast<std::size_t>(region)]; }
  [[nodiscard]] Vec3 tangent() const { return needle_.tangent(needle_.length()); }

  const InsertionTissue& mesh_;
  const CouplingSettings& settings_;
  const Needle& needle_;
  TissueResponse& tissue_;
  TipState phase_ = TipState::air;
  Vec3 air_tip_ = Vec3::Zero();                     ///< [mm] LPS, undeformed: where the tip was while it was in the air
  std::optional<NeedleWhereabouts> awaited_entry_;  ///< surface that was met where no compliance is there yet
  static constexpr std::size_t kMostEvents = 16;
  std::array<InsertionEvent, kMostEvents> event_;
  std::size_t event_count_ = 0;
  bool went_past_surface_ = false;  ///< too far beyond that surface: it is to be drawn out first
};

}  // namespace stylet
