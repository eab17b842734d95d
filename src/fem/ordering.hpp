// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include <cholmod.h>

#include <span>
#include <vector>

namespace stylet::detail {

/// CHOLMOD's view of a symmetric matrix, of which it reads the lower triangle. Refers to A.
/// @param xtype CHOLMOD_REAL, or CHOLMOD_PATTERN for the pattern alone
cholmod_sparse view(const Eigen::SparseMatrix<double>& A, int xtype);

/// The order in which nodes are eliminated: METIS' nested dissection of all but `last`, in postorder of the elimination
/// tree, then `last` in their own order. Dissecting what is left without them, and not the whole, keeps separators
/// from being wasted on nodes that are one separator already.
/// @param nodes symmetric pattern with diagonal, compressed (b × b)
/// @param last columns of `nodes`, each once
/// @return nodes in the order of elimination (b); empty on failure, with the reason in common.status
std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& nodes, std::span<const int> last,
                                   cholmod_common& common);

}  // namespace stylet::detail
