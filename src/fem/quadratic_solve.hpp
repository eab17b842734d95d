// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "discretisation.hpp"
#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <vector>

namespace stylet::detail {

/// Solves u = K⁻¹ f on quadratic tetrahedra for several loads by conjugate gradients. The preconditioner is the factor
/// of linear elements on the same mesh plus the inverse diagonal blocks of K. The factor of K itself would take several
/// times the time and memory (docs/theory/tissue.md, Factor); it is made only where the iteration does not converge, as
/// for ν close to 0.5.
/// @param quadratic quadratic elements on `mesh`
/// @param materials one per region of the mesh
/// @param fixed mesh nodes that are held, ascending; they must exclude rigid motion
/// @param f [N] (3n × loads) over all displacement nodes; rows of held nodes are ignored
/// @return [mm] (3n × loads), zero at held nodes. Errors are those of Tissue::build()
Result<MatX> solve_quadratic(const Discretisation& quadratic, const TetMesh& mesh,
                             const std::vector<Material>& materials, const std::vector<Index>& fixed, const MatX& f,
                             const Progress& progress = {});

}  // namespace stylet::detail
