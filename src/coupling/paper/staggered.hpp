// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/paper/anderson.hpp"
#include "stylet/coupling/paper/condensed_system.hpp"

#include <limits>

namespace stylet::paper {

/// What the staggered solver keeps from step to step. Loads are numbered as in Insertion: the tip first, then the shaft
/// contacts; their places in K_W ("slots") change as contacts come and go.
struct Staggered {
  /// @param shape size of the needle's state
  Staggered(int contacts, Eigen::Index shape)
      : system(contacts),
        acceleration(shape),
        shape_before(VecX::Zero(shape)),
        shape_after(VecX::Zero(shape)),
        y(VecX::Zero(3 * contacts)),
        x(VecX::Zero(3 * contacts)),
        across(MatX::Zero(3 * contacts, 3)),
        frames(static_cast<std::size_t>(contacts), Mat3::Identity()),
        points(static_cast<std::size_t>(contacts), -1),
        slot_of(static_cast<std::size_t>(contacts), 0),
        load_of(static_cast<std::size_t>(contacts), 0) {}

  CondensedSystem system;
  Anderson acceleration;
  VecX shape_before;         ///< needle's state before it was bent
  VecX shape_after;          ///< … and after
  VecX y;                    ///< (3 slots) displacement [mm] or force [N], as each row is controlled
  VecX x;                    ///< (3 slots) the other one
  MatX across;               ///< scratch
  std::vector<Mat3> frames;  ///< (loads) that K_W is written in: columns n1, n2, t
  std::vector<int> points;   ///< (loads) in ContactCompliance
  std::vector<int> slot_of;  ///< (loads)
  std::vector<int> load_of;  ///< (slots)
  unsigned version = std::numeric_limits<unsigned>::max();  ///< of the compliance K_W was made from
  double share = 1.0;                                       ///< of that compliance which is felt at once
  Vec3 tip = Vec3::Zero();                                  ///< [mm] where the tip's column was made
  double advance = 0.0;                                     ///< [mm] of the cut in this sub-step
  double change = 0.0;  ///< [N] by which friction and cutting forces still change from one iteration to the next
};

}  // namespace stylet::paper
