// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// How much of a patient is meshed, and how finely unless a number of nodes is given.
enum class MeshPreset {
  standard,  ///< all anatomy of the input, about 3,000 nodes
  paper      ///< the target and its surroundings only, 570 nodes, as Goksel et al. 2005
};

}  // namespace stylet
