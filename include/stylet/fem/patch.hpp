// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <span>
#include <vector>

namespace stylet {

/// Stiffness of a few elements by themselves, held by nothing.
struct PatchStiffness {
  std::vector<Index> nodes;  ///< displacement nodes of the elements, ascending (p)
  MatX K;  ///< [N/mm] symmetric, (3p × 3p), rows in the order of `nodes`; rigid motions are its kernel
};

/// Stiffness of the elements `tets` alone, all of one material, with the tissue's kind of element; supports of the
/// tissue are treated as free. Dense: for patches of some hundred nodes. Allocates; not for the step.
/// @param tets numbers of tetrahedra of the tissue's mesh, each at most once
PatchStiffness patch_stiffness(const Tissue& tissue, std::span<const Index> tets, const Material& material);

}  // namespace stylet
