// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/paper/adapted_mesh.hpp"
#include "stylet/measure/remesh_cost.hpp"

namespace stylet::measure {

/// A node that is added on the needle's way, with the data that the methods need.
struct AddedNode {
  MaterialPoint at;  ///< its place in the initial mesh
  Vec3 x = Vec3::Zero();
  Vec3 travel = Vec3::Zero();
  paper::AdaptedMesh::Change change;
  std::vector<Index> dofs;  ///< (k) rows of K that ΔK changes; the last three belong to the new node
};

/// Nodes along the way, each accepted by TrackCompliance. With Placement::interior they lie inside elements every
/// `spacing_mm`, up to 3 mm beside the way where a face is too near. With Placement::face they lie on the crossed
/// faces, at least `spacing_mm` apart.
std::vector<AddedNode> nodes_along(const NeedleWay& way, const RemeshCostOptions& options);

/// ΔK [N/mm] (k × k): the stiffness of the new elements minus that of the removed elements, on AddedNode::dofs.
MatX stiffness_change(const Tissue& tissue, const AddedNode& node);

}  // namespace stylet::measure
