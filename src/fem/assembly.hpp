// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "discretisation.hpp"

#include <Eigen/SparseCore>

namespace stylet::detail {

/// The stiffness on the free degrees of freedom and its pattern of coupled nodes.
struct Assembled {
  Eigen::SparseMatrix<double> K;        ///< [N/mm] symmetric to the last bit, both triangles (free × free)
  Eigen::SparseMatrix<double> pattern;  ///< pattern of K's 3 × 3 blocks (free nodes square), numbered by free node
};

/// Assembles the stiffness of the whole mesh from the parts that the discretisation gives.
/// @param first_dof (nodes) first degree of freedom of each node, -1 for a fixed node
Assembled assemble(const Discretisation& discretisation, Index tets, const Discretisation::MaterialOf& material,
                   const std::vector<Index>& first_dof, Index free_dofs);

}  // namespace stylet::detail
