// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

namespace stylet::validate {

/// True when the program ccx is there.
bool calculix_installed();

/// The problem in CalculiX's input language: linear tetrahedra (C3D4), one material and one set of elements per region,
/// fixed nodes, nodal loads; displacements are printed with *NODE PRINT, which keeps seven digits.
/// @param f [N] (3n)
std::string calculix_deck(const TetMesh& mesh, const std::vector<Material>& materials, const std::vector<Index>& fixed,
                          const VecX& f);

/// Displacements of the same mesh, materials, supports and loads by CalculiX [mm] (3n), with one thread, in a folder of
/// its own under the system's folder for temporary files.
/// Errors: failed, when ccx is not there, does not end well, or leaves a displacement out.
Result<VecX> solve_with_calculix(const TetMesh& mesh, const std::vector<Material>& materials,
                                 const std::vector<Index>& fixed, const VecX& f);

}  // namespace stylet::validate
