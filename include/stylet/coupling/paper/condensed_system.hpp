// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/paper/inverse_updates.hpp"

#include <vector>

namespace stylet::paper {

/// The condensed system x = K_W y of the w contact points, three rows for each in the point's own frame (two lateral,
/// one axial). A row is either force-controlled (y a force [N], x a displacement [mm]) or displacement-controlled (y a
/// displacement, x a force), and is switched between the two as the needle sticks and slips. With all rows
/// force-controlled K_W is the tissue's compliance. A row may have a softness d [mm/N] of its own: its displacement is
/// then u + d f. Nothing allocates after construction. @cite Goksel2005 DiMaio2003
class CondensedSystem {
 public:
  explicit CondensedSystem(int capacity);

  void clear() { points_ = 0; }
  [[nodiscard]] int points() const { return points_; }

  /// Adds a point, force-controlled. With B the displacement-controlled rows and F the other rows, its column is
  ///   col_B = −K_BB A_Bp,   col_F = A_Fp − K_FB A_Bp.
  /// @param across A between the points so far and the new point, all in their own frames (3 points() × 3)
  /// @param own A between the new point and itself, in its frame
  int add(const Eigen::Ref<const MatX>& across, const Mat3& own);

  /// Removes a point. Its rows are first switched to force control without force. The last point takes over its number.
  void remove(int point);

  /// Switches a row, O(w²).
  void control_displacement(int row, bool displacement);
  [[nodiscard]] bool is_displacement(int row) const { return displacement_[static_cast<std::size_t>(row)]; }

  /// Turns a point's frame: v_new = S v_old for its rows and columns. This is exact only while the three rows have the
  /// same control, so they are switched to force control, turned, and switched back.
  void rotate(int point, const Mat3& S);

  /// Sets the softness d of a row [mm/N].
  void set_softness(int row, double softness);

  /// K_W, leading 3 points() rows and columns.
  [[nodiscard]] Eigen::Block<const MatX> matrix() const { return K_.topLeftCorner(3 * points_, 3 * points_); }
  [[nodiscard]] double operator()(int i, int j) const { return K_(i, j); }

  /// Number of switches since the last clear(); the rounding errors of switches accumulate.
  [[nodiscard]] long switches() const { return switches_; }

 private:
  void switch_row(int row);
  template <class Change>
  void under_force_control(int point, Change&& change);

  int points_ = 0;
  long switches_ = 0;
  MatX K_;
  VecX softness_;
  std::vector<char> displacement_;
  std::vector<double> left_;
  std::vector<double> right_;
  MatX held_;  ///< A_Bp of add()
};

}  // namespace stylet::paper
