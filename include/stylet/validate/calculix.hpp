// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

namespace stylet::validate {

/// True when the program ccx is there.
bool calculix_installed();

/// The problem in CalculiX's input language: linear (C3D4) or quadratic tetrahedra (C3D10), as the tissue's, one
/// material and one set of elements per region, fixed nodes, nodal loads; displacements are printed with *NODE PRINT,
/// which keeps seven digits. CalculiX has no averaged nodal pressure.
/// @param tissue of linear or quadratic tetrahedra
/// @param f [N] (3 × displacement nodes)
std::string calculix_deck(const Tissue& tissue, const VecX& f);

/// Displacements of the same mesh, materials, supports and loads by CalculiX [mm] (3 × displacement nodes), with one
/// thread, in a folder of its own under the system's folder for temporary files.
/// Errors: failed, when ccx is not there, does not end well, or leaves a displacement out.
Result<VecX> solve_with_calculix(const Tissue& tissue, const VecX& f);

}  // namespace stylet::validate
