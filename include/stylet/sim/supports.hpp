// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet {

/// The nodes that are held.
struct Supports {
  std::vector<Index> nodes;              ///< node numbers, ascending
  std::vector<int> rigid_regions;        ///< regions all of whose nodes are held
  std::vector<std::string> description;  ///< sentences for the report that say what is held and why
};

/// Whether a region of this canonical name is a bone: the pubic arch or a femur.
bool is_bone(const std::string& region);

/// Determines the nodes with zero displacement. Bones (pubic arch, femurs, or the regions that the scenario names) are
/// held whole. Without a pubic arch, or with fixed.outer = "sides", the outer faces are held too, except for the
/// perineal face (facing inferior, below the target) and everything within 30 mm of an entry. A mesh of unnamed tissue
/// is held at the outer faces of its far half, seen along the needle.
/// @param target regions that form the target; may be empty
/// @param entries [mm] LPS, entry points of the needles @param directions unit vectors, LPS, of the needles
/// Errors: an unknown region, a box without nodes, nothing held.
Result<Supports> find_supports(const TetMesh& mesh, const Topology& topology, const Scenario::Fixed& fixed,
                               const std::vector<int>& target, const std::vector<Vec3>& entries,
                               const std::vector<Vec3>& directions);

}  // namespace stylet
