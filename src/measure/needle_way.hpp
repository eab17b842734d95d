// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/paper/adapted_mesh.hpp"
#include "stylet/measure/remesh_cost.hpp"

namespace stylet::measure {

/// A node that the needle's way adds, with all that the methods need to know.
struct AddedNode {
  MaterialPoint at;  ///< in the base mesh
  Vec3 x = Vec3::Zero();
  Vec3 travel = Vec3::Zero();
  paper::AdaptedMesh::Change change;
  std::vector<Index> dofs;  ///< (k) rows of K that ΔK belongs to; those of the new node are the last three
};

/// Nodes along the way, each accepted by TrackCompliance: inside elements every `spacing_mm`, up to 3 mm beside the way
/// where a face is too near, or on the faces crossed, at least `spacing_mm` apart.
std::vector<AddedNode> nodes_along(const NeedleWay& way, const RemeshCostOptions& options);

/// ΔK [N/mm] (k × k): the elements put in their place, less those taken away. @param dofs as in AddedNode
MatX stiffness_change(const Tissue& tissue, const AddedNode& node);

}  // namespace stylet::measure
