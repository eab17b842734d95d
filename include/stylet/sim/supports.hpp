// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet {

/// Which nodes are held, and why, in words for the report.
struct Supports {
  std::vector<Index> nodes;        ///< sorted
  std::vector<int> rigid_regions;  ///< regions all of whose nodes are held
  std::vector<std::string> description;
};

/// Whether a region of this canonical name is a bone: the pubic arch or a femur.
bool is_bone(const std::string& region);

/// The fundamental displacement constraints. Bones (pubic arch, femurs, or the regions the scenario names) are held
/// whole. Without a pubic arch, or with fixed.outer = "sides", the outer faces are held too, except the perineal face
/// (facing inferior, below the target) and what lies within 30 mm of an entry. A mesh of unnamed tissue is held on the
/// far half, seen from the needle.
/// @param target regions that form the target, may be empty
/// @param entries [mm] LPS where needles go in, @param directions their unit directions
Result<Supports> find_supports(const TetMesh& mesh, const Topology& topology, const Scenario::Fixed& fixed,
                               const std::vector<int>& target, const std::vector<Vec3>& entries,
                               const std::vector<Vec3>& directions);

}  // namespace stylet
