// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <span>
#include <vector>

namespace stylet {

/// Stiffness of a few elements cut out of the mesh. Only the nodes with given displacements hold them.
struct Patch {
  std::vector<Index> nodes;  ///< (p) displacement nodes of the elements: first the nodes that move, then the others
  Index moving = 0;          ///< number m of nodes that move
  MatX K;  ///< [N/mm] (3m × 3p) rows of the stiffness for the nodes that move, columns in the order of `nodes`

  /// Solves for the displacements of the nodes that move.
  /// @param given [mm] displacements of the other nodes (3(p − m) × loads)
  /// @param forces [N] on the nodes that move (3m × loads)
  /// @return [mm] (3m × loads)
  [[nodiscard]] MatX displacements(const MatX& given, MatX forces) const;
};

/// Assembles the stiffness of the elements `tets` alone, as if all were of one material, with the tissue's kind of
/// element. Supports of the tissue have no effect other than through `moves`. The matrix is dense: meant for patches of
/// some hundred nodes. Allocates; not to be called in a step.
/// @param tets numbers of tetrahedra of the tissue's mesh, each at most once
/// @param nodes displacement nodes of these elements, ascending (p)
/// @param moves (p) whether a node moves; moving nodes, and the others, keep their order
Patch make_patch(const Tissue& tissue, std::span<const Index> tets, std::span<const Index> nodes,
                 const std::vector<char>& moves, const Material& material);

}  // namespace stylet
