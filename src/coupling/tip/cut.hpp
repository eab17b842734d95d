// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/tip/passed_surface.hpp"
#include "coupling/tissue_response.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The end of the track while the tip cuts: its place, and the length of cut in this sub-step. The iterations of a
/// balance move it forward and back; the track itself grows only afterwards (TipPath::commit). All places are
/// undeformed. A long cut in one sub-step has several legs, each with a direction of its own.
class Cut {
 public:
  /// A place on the way of the cut.
  struct Place {
    Vec3 x = Vec3::Zero();  ///< [mm] LPS
    MaterialPoint at;       ///< its element and weights
    double advance = 0.0;   ///< [mm] length of cut in this sub-step up to there
  };

  /// @param locator, tissue outlive the cut
  Cut(const Locator& locator, TissueResponse& tissue);

  [[nodiscard]] const Place& end() const { return end_; }            ///< of the track
  [[nodiscard]] const Vec3& x() const { return end_.x; }             ///< [mm] LPS, the same
  [[nodiscard]] const MaterialPoint& at() const { return end_.at; }  ///< the same; element −1: the tip is in no track
  [[nodiscard]] double advance() const { return end_.advance; }      ///< [mm] length of cut in this sub-step
  [[nodiscard]] const Place& start() const { return start_; }        ///< of the present leg
  [[nodiscard]] std::span<const Place> legs() const { return legs_; }  ///< starts of those before it
  [[nodiscard]] const Vec3& direction() const { return direction_; }   ///< LPS, unit vector of the cut
  /// Whether the cut has met a surface in this sub-step; its end is then on the surface.
  [[nodiscard]] bool is_blocked() const { return blocked_; }
  [[nodiscard]] const Crossing& crossing() const { return crossing_; }  ///< the crossing with that surface
  /// Whether the cut would go on beyond its leg.
  [[nodiscard]] bool ends_leg() const { return ends_leg_; }
  /// Whether the compliance at the end is missing, so that the compliance of the last place is used.
  [[nodiscard]] bool is_stale() const { return stale_; }

  /// Moves the end to another place: x [mm] LPS in the element of `at`.
  void put(const Vec3& x, const MaterialPoint& at);
  /// Resets the cut: the tip has left the tissue.
  void forget();

  /// Begins a sub-step: the length of cut is measured from here.
  void begin();
  /// Reads the compliance at the end again, in case it has arrived; the tissue does not move by this.
  void take_compliance() { stale_ = !tissue_.move_tip(end_.at, end_.x); }
  /// @param direction LPS, of any length; not followed where it leads back to a surface directly behind it
  void aim(const Vec3& direction) { direction_ = passed_.direction(end_.x, direction); }
  /// Moves the end to `advance` [mm] beyond its place at the start of the sub-step, or to the first surface before
  /// that, but not back beyond the start of the leg.
  void march(double advance);
  /// The same, but at most to the end of the longest leg.
  void march_in_leg(double advance);
  /// The same as march(), but does not move the end if a surface is in the way.
  void march_before_surface(double advance);
  /// Begins another leg at the end of this one.
  void begin_leg();
  /// Returns to the start of the first leg.
  void take_back();
  /// Moves to the element behind the surface at the end; the length of cut is measured from here.
  /// @param inwards LPS, unit normal of the surface @param tangent LPS, unit tangent of the needle at its tip
  void enter(Index tet, const Vec3& inwards, const Vec3& tangent);
  /// Clears is_blocked(), after the caller has handled the surface.
  void unblock() { blocked_ = false; }

 private:
  void count_from_here();

  const Locator& locator_;
  TissueResponse& tissue_;
  Place start_, end_;
  std::vector<Place> legs_;
  Vec3 direction_ = Vec3::UnitZ();
  bool ends_leg_ = false;
  bool blocked_ = false;
  bool stale_ = false;
  Crossing crossing_;
  PassedSurface passed_;
};

}  // namespace stylet
