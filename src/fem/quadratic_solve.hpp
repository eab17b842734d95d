// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "discretisation.hpp"
#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <vector>

namespace stylet::detail {

/// u = K⁻¹ f on quadratic tetrahedra, for several loads: conjugate gradients, preconditioned by the factor of linear
/// elements on the same mesh and by K's diagonal blocks. The factor of K itself takes several times the time and memory
/// (docs/theory/tissue.md, Factor); it is made where the iteration does not converge, as for ν next to 0.5.
/// @param quadratic elements on `mesh`
/// @param materials one per region of the mesh
/// @param fixed nodes of the mesh that are held, enough to exclude rigid motion, ascending
/// @param f [N] (3n × loads) over all displacement nodes, rows of held ones are ignored
/// @return [mm] (3n × loads), zero at held nodes. Errors: those of Tissue::build()
Result<MatX> solve_quadratic(const Discretisation& quadratic, const TetMesh& mesh,
                             const std::vector<Material>& materials, const std::vector<Index>& fixed, const MatX& f,
                             const Progress& progress = {});

}  // namespace stylet::detail
