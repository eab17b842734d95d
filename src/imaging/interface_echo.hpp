// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/tissue_role.hpp"

namespace stylet {

/// Echo of a smooth border between tissues.
struct InterfaceEcho {
  float level_dB = -100.0F;   ///< at a right angle, as the level of speckle
  float falloff = 4.0F;       ///< exponent of the cosine between beam and normal
  double roughness_mm = 0.1;  ///< of its place
};

/// The echo of the border between two kinds of tissue. Levels are stated, by how bright these borders look in
/// transrectal pictures; only the order follows from the tissues' impedances.
InterfaceEcho interface_echo(TissueRole a, TissueRole b);

}  // namespace stylet
