// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/tissue_response.hpp"

namespace stylet {

/// The end of the track while the tip cuts: where it is, and how far it has come in the sub-step. A balance may move it
/// to and fro until it is found; the track itself grows only afterwards (TipPath::commit). All places are undeformed.
class Cut {
 public:
  /// @param locator, tissue outlive the cut
  Cut(const Locator& locator, TissueResponse& tissue) : locator_(locator), tissue_(tissue) {}

  [[nodiscard]] const Vec3& x() const { return x_; }              ///< [mm] LPS, where the end is
  [[nodiscard]] const MaterialPoint& at() const { return at_; }   ///< its element; −1 = the tip is in no track
  [[nodiscard]] const Vec3& x_start() const { return x_start_; }  ///< [mm] LPS, where the sub-step began
  [[nodiscard]] const MaterialPoint& at_start() const { return at_start_; }
  [[nodiscard]] const Vec3& direction() const { return direction_; }  ///< LPS, unit vector in which it goes on
  [[nodiscard]] double advance() const { return advance_; }           ///< [mm] way of the sub-step
  /// Whether a surface was met in this sub-step; the end lies on it.
  [[nodiscard]] bool is_blocked() const { return blocked_; }
  [[nodiscard]] const Crossing& crossing() const { return crossing_; }  ///< of that surface
  /// Whether there is no compliance for where the end is: the compliance of its last place stands in for it.
  [[nodiscard]] bool is_stale() const { return stale_; }

  /// The tip touches material at another place: x [mm] LPS in the element of `at`.
  void put(const Vec3& x, const MaterialPoint& at);
  /// The tip has left the tissue.
  void forget();

  /// A sub-step begins: its way is counted from here.
  void begin();
  /// Compliance that was missing is taken, if it is there by now; the tissue does not move by it.
  void take_compliance() { stale_ = !tissue_.move_tip(at_, x_); }
  /// @param direction LPS, unit vector
  void aim(const Vec3& direction) { direction_ = direction; }
  /// Puts the end `advance` [mm] beyond where the sub-step began, or on the first surface before that.
  void march(double advance);
  /// The same, or nothing if a surface is in the way.
  void march_before_surface(double advance);
  /// Goes over to the element behind the surface that the end lies on; the way is counted from there.
  void enter(Index tet);
  /// The surface that was met no longer stops the cut: somebody has decided what becomes of it.
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
