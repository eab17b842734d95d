// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/needle_damping.hpp"
#include "coupling/contacts/shaft_contacts.hpp"
#include "coupling/hand_force.hpp"
#include "coupling/tip/tip_path.hpp"

#include <memory>
#include <utility>

namespace stylet {

/// A needle, its path and its contacts. The tissue is shared by all needles.
struct NeedleInTissue {
  /// The references outlive the needle.
  NeedleInTissue(const InsertionTissue& mesh, const CouplingSettings& settings, std::unique_ptr<Needle> needle_,
                 TissueResponse& tissue)
      : needle(std::move(needle_)),
        path(mesh, settings, base, *needle, tissue),
        shaft(mesh, settings, *needle, tissue),
        hand(base, *needle),
        damping(settings.bone_damping_s) {}

  std::unique_ptr<Needle> needle;
  Pose base;  ///< as the hand gives it; while the needle rests, where the hand left it
  TipPath path;
  ShaftContacts shaft;  ///< empty while the needle rests: its contacts are then with those of the held needle
  HandForce hand;
  NeedleDamping damping;
  int tip_point = -1;  ///< while the needle rests, the point that stands for its tip; −1: its tip does not press

  [[nodiscard]] bool in_air() const { return path.in_air(); }
};

}  // namespace stylet
