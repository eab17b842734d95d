// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "discretisation.hpp"

#include <Eigen/SparseCore>

namespace stylet::detail {

/// The stiffness on the free degrees of freedom, and who is coupled to whom.
struct Assembled {
  Eigen::SparseMatrix<double> K;        ///< [N/mm] symmetric to the last bit, both triangles (free × free)
  Eigen::SparseMatrix<double> pattern;  ///< of its 3 × 3 blocks, in free-node numbers
};

/// Sums the parts of the whole mesh's stiffness.
/// @param first_dof (nodes) a node's first degree of freedom, -1 where it is held
Assembled assemble(const Discretisation& discretisation, Index tets, const Discretisation::MaterialOf& material,
                   const std::vector<Index>& first_dof, Index free_dofs);

}  // namespace stylet::detail
