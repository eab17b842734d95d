// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <string>
#include <vector>

namespace stylet::validate {

/// Whether the program ccx (CalculiX) is installed.
bool calculix_installed();

/// Kinematics and material law of the solid in CalculiX.
enum class Geometry {
  linear,  ///< small displacements and Hooke's law, as in Tissue
  /// Displacements of any size in a compressible neo-Hookean solid with the same moduli at small strain:
  /// energy μ/2 (J^(−2/3) tr C − 3) + κ/2 (J − 1)², where κ is the bulk modulus. Loads keep their direction.
  finite
};

/// Writes the problem in CalculiX's input language: the tissue's linear (C3D4) or quadratic tetrahedra (C3D10), one
/// material and one set of elements per region, fixed nodes and nodal loads. Displacements are printed with *NODE
/// PRINT, which keeps seven digits. CalculiX has no element with averaged nodal pressure.
/// @param tissue tissue of linear or quadratic tetrahedra
/// @param f [N] (3 × displacement nodes) nodal loads
std::string calculix_deck(const Tissue& tissue, const VecX& f, Geometry geometry = Geometry::linear);

/// Solves the same mesh, materials, supports and loads with CalculiX. It runs with one thread in a temporary folder.
/// @return displacements [mm] (3 × displacement nodes)
/// Errors: failed, when ccx is not installed, fails, or does not print all displacements.
Result<VecX> solve_with_calculix(const Tissue& tissue, const VecX& f);

/// The displacements at one increment of a growing load.
struct LoadedMoment {
  double share = 0.0;  ///< part of the whole load that is applied, 0…1
  VecX u;              ///< [mm] (3 × displacement nodes)
};

/// Solves a neo-Hookean solid (Geometry::finite) under a growing load with CalculiX. The result has the increments that
/// CalculiX chose; the last one has less than the whole load if no further equilibrium was found.
/// Errors: failed, when ccx is not installed or no increment converged.
Result<std::vector<LoadedMoment>> load_with_calculix(const Tissue& tissue, const VecX& f);

}  // namespace stylet::validate
