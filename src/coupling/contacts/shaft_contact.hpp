// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/pace.hpp"
#include "stylet/coupling/laws.hpp"

#include <span>

namespace stylet {

class Needle;

/// A contact between the shaft and a tissue point.
struct ShaftContact {
  enum class State {
    stick,
    forward,  ///< the needle slides into the tissue, and friction pushes the tissue along
    backward  ///< the needle slides out of the tissue, and friction pulls the tissue along
  };

  // The place of the contact.
  const Needle* needle = nullptr;  ///< the needle whose shaft it holds
  int point = -1;                  ///< number of its point in ContactCompliance
  double xi = 0.0;                 ///< [mm] arc length along the track
  Vec3 x = Vec3::Zero();           ///< [mm] LPS, undeformed tissue point
  double s = 0.0;                  ///< [mm] present arc length on the needle, from the base
  double length = 0.0;             ///< [mm] tributary length: the length of shaft that it stands for

  // Its state and force.
  FrictionLaw law;
  State state = State::stick;
  bool fast = false;          ///< whether it slides faster than FrictionLaw::viscous_to_mm_per_s
  double softness = 0.0;      ///< [mm/N] own yield of a young contact, by which contacts come and go without a jump
  double coulomb = 0.0;       ///< [N] sliding friction extrapolated to zero speed, from the branch (slow or fast) of
                              ///< the present speed
  double slip = 0.0;          ///< [mm/N] distance that it slides in this sub-step per force beyond `coulomb`
  double reach = 0.0;         ///< [mm] distance that it slides in this sub-step at the speed where friction stops
                              ///< growing
  int toggles = 0;            ///< changes of state in this sub-step
  Vec3 force = Vec3::Zero();  ///< [N] LPS, on the tissue

  /// Whether it stands for the tip of a needle at rest. Such a tip presses the tissue with at most its cutting force,
  /// does not pull it, and stays open once the tissue has left it.
  bool presses_only = false;

  // Values for the predictor.
  double s_start = 0.0;              ///< [mm] s at the start of the sub-step
  State state_start = State::stick;  ///< state and `fast` at the start of the sub-step
  bool fast_start = false;
  double slid = 0.0;       ///< [mm] change of s in the last sub-step
  double slid_more = 0.0;  ///< [mm] the part of that change that was not in proportion to the previous change
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
