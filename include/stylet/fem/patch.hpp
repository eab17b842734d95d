// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <span>
#include <vector>

namespace stylet {

/// Stiffness of a few elements by themselves, held by nothing but the nodes whose displacements are given.
struct Patch {
  std::vector<Index> nodes;  ///< displacement nodes of the elements: first those that move, then the others (p)
  Index moving = 0;          ///< nodes that move (m)
  MatX K;                    ///< [N/mm] rows of the nodes that move (3m × 3p), in the order of `nodes`

  /// Displacements [mm] (3m × loads) of the nodes that move.
  /// @param given [mm] displacements of the others (3(p − m) × loads)
  /// @param forces [N] on the nodes that move (3m × loads)
  [[nodiscard]] MatX displacements(const MatX& given, MatX forces) const;
};

/// Of the elements `tets` alone, all of one material, with the tissue's kind of element; supports of the tissue count
/// only where `moves` says so. Dense: for patches of some hundred nodes. Allocates; not for the step.
/// @param tets numbers of tetrahedra of the tissue's mesh, each at most once
/// @param nodes their displacement nodes, ascending (p)
/// @param moves (p) whether a node moves; both groups keep their order
Patch make_patch(const Tissue& tissue, std::span<const Index> tets, std::span<const Index> nodes,
                 const std::vector<char>& moves, const Material& material);

}  // namespace stylet
