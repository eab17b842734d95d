// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/pace.hpp"
#include "stylet/coupling/laws.hpp"

#include <span>

namespace stylet {

/// A place where shaft and tissue hold each other.
struct ShaftContact {
  enum class State {
    stick,
    forward,  ///< the needle slides into the tissue and friction pushes the tissue along
    backward  ///< the needle slides out of the tissue
  };

  // Where it is.
  int point = -1;         ///< its number in ContactCompliance
  double xi = 0.0;        ///< [mm] along the track
  Vec3 x = Vec3::Zero();  ///< [mm] LPS, tissue point, undeformed
  double s = 0.0;         ///< [mm] its present place along the needle, from the base
  double length = 0.0;    ///< [mm] length of shaft that it stands for

  // How it holds.
  FrictionLaw law;
  State state = State::stick;
  bool fast = false;          ///< it slides faster than the speed up to which friction grows
  double softness = 0.0;      ///< [mm/N] yield of a young contact, so that contacts come and go without a jump
  double coulomb = 0.0;       ///< [N] sliding friction, continued to speed 0 from the present speed
  double slip = 0.0;          ///< [mm/N] way it slides in this sub-step for each newton beyond `coulomb`
  double reach = 0.0;         ///< [mm] way it slides in this sub-step at the speed where friction stops growing
  int toggles = 0;            ///< changes of state in this sub-step
  Vec3 force = Vec3::Zero();  ///< [N] LPS, on the tissue

  // What the predictor knows of it.
  double s_start = 0.0;    ///< [mm] s at the start of the sub-step
  double slid = 0.0;       ///< [mm] change of s in the last sub-step
  double slid_more = 0.0;  ///< [mm] the part of that change that was not in proportion to the change before
  ForceHistory history;

  [[nodiscard]] bool sticks() const { return state == State::stick; }
  /// +1 where friction pushes the tissue along the needle's direction, −1 where it pushes the other way.
  [[nodiscard]] double sense() const { return state == State::forward ? 1.0 : -1.0; }
};

/// The forces of all contacts on the tissue.
struct ContactForces {
  const Vec3& tip;  ///< [N] LPS
  std::span<const ShaftContact> shaft;
};

}  // namespace stylet
