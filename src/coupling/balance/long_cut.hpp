// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"

namespace stylet {

/// Aims the cut of a balance anew, if it is long. In a sub-step a cut is straight, and it is aimed at its start. Behind
/// a surface that breaks, the tissue that the tip has pushed ahead springs back, so that one to three millimetres are
/// cut in one sub-step, on which the strain at the tip, and with it the direction, changes as much as the force. A long
/// cut therefore takes the mean of its directions, so that the track does not depend on the time step.
/// @return false, with nothing changed, where the cut is short, or its end would hardly move
[[nodiscard]] bool aim_long_cut(const Contacts& contacts);

}  // namespace stylet
