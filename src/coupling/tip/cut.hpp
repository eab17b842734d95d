// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/tissue_response.hpp"

namespace stylet {

/// The end of the track while the tip cuts: its place, and the length of cut in this sub-step. The iterations of a
/// balance move it forward and back; the track itself grows only afterwards (TipPath::commit). All places are
/// undeformed.
class Cut {
 public:
  /// @param locator, tissue outlive the cut
  Cut(const Locator& locator, TissueResponse& tissue) : locator_(locator), tissue_(tissue) {}

  [[nodiscard]] const Vec3& x() const { return x_; }  ///< [mm] LPS, the end of the track
  [[nodiscard]] const MaterialPoint& at() const {
    return at_;
  }                                                               ///< its element and weights; element −1: the tip is
                                                                  ///< in no track
  [[nodiscard]] const Vec3& x_start() const { return x_start_; }  ///< [mm] LPS, the end at the start of the sub-step
  [[nodiscard]] const MaterialPoint& at_start() const { return at_start_; }
  [[nodiscard]] const Vec3& direction() const { return direction_; }  ///< LPS, unit vector of the cut
  [[nodiscard]] double advance() const { return advance_; }           ///< [mm] length of cut in this sub-step
  /// Whether the cut has met a surface in this sub-step; its end is then on the surface.
  [[nodiscard]] bool is_blocked() const { return blocked_; }
  [[nodiscard]] const Crossing& crossing() const { return crossing_; }  ///< the crossing with that surface
  /// Whether the compliance at the end is missing, so that the compliance of the last place is used.
  [[nodiscard]] bool is_stale() const { return stale_; }

  /// Moves the end to another place: x [mm] LPS in the element of `at`.
  void put(const Vec3& x, const MaterialPoint& at);
  /// Resets the cut: the tip has left the tissue.
  void forget();

  /// Begins a sub-step: the length of cut is measured from here.
  void begin();
  /// Reads the compliance at the end again, in case it has arrived; the tissue does not move by this.
  void take_compliance() { stale_ = !tissue_.move_tip(at_, x_); }
  /// @param direction LPS, unit vector
  void aim(const Vec3& direction) { direction_ = direction; }
  /// Moves the end to `advance` [mm] beyond its place at the start of the sub-step, or to the first surface before
  /// that.
  void march(double advance);
  /// The same, but does not move the end if a surface is in the way.
  void march_before_surface(double advance);
  /// Moves to the element behind the surface at the end; the length of cut is measured from here.
  void enter(Index tet);
  /// Clears is_blocked(), after the caller has handled the surface.
  void unblock() { blocked_ = false; }

 private:
  void count_from_here();

  const Locator& locator_;
  TissueResponse& tissue_;
  Vec3 x_ = Vec3::Zero();
  MaterialPoint at_;
  Vec3 x_start_ = Vec3::Zero();
  MaterialPoint at_start_;
  Vec3 direction_ = Vec3::UnitZ();
  double advance_ = 0.0;
  bool blocked_ = false;
  Crossing crossing_;
  bool stale_ = false;
};

}  // namespace stylet
