// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Which part of a patient is meshed, and how finely where no number of nodes is given.
enum class MeshPreset {
  standard,  ///< the whole anatomy of the input, about 3,000 nodes
  paper      ///< only the target and its surroundings, 570 nodes, as in Goksel et al. 2005
};

}  // namespace stylet
