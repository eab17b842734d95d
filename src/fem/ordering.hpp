// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include <cholmod.h>

#include <span>
#include <vector>

namespace stylet::detail {

/// CHOLMOD's view of a symmetric matrix, of which CHOLMOD reads the lower triangle. Refers to the memory of A.
/// @param xtype CHOLMOD_REAL, or CHOLMOD_PATTERN for the pattern alone
cholmod_sparse view(const Eigen::SparseMatrix<double>& A, int xtype);

/// Order of elimination by nested dissection, that of cholmod_metis(), from METIS itself. cholmod_metis() calls
/// METIS_NodeND(), which takes over SIGTERM and SIGABRT of the whole process for as long as it works: a SIGTERM then
/// ended the program with SIGSEGV where another thread received it, and was lost otherwise, the order with it.
/// @param pattern symmetric, stored as its lower triangle, with diagonal (n × n)
/// @return numbers of columns in the order of elimination (n); empty on failure, with the reason in common.status
std::vector<int> nested_dissection(cholmod_sparse& pattern, cholmod_common& common);

/// Order in which nodes are eliminated: nested dissection (METIS) of all nodes but `last`, in postorder of the
/// elimination tree, then `last` in the given order. The graph without `last` is dissected, not the whole one, because
/// `last` already acts as a separator.
/// @param nodes symmetric pattern with diagonal, compressed (b × b)
/// @param last columns of `nodes`, each once
/// @return nodes in the order of elimination (b); empty on failure, with the reason in common.status
std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& nodes, std::span<const int> last,
                                   cholmod_common& common);

}  // namespace stylet::detail
