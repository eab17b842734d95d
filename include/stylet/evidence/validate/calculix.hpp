// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <string>
#include <vector>

namespace stylet::validate {

/// True when the program ccx is there.
bool calculix_installed();

/// How CalculiX takes the solid that it is given.
enum class Geometry {
  linear,  ///< Hooke's law for small displacements, as Tissue has it
  /// Displacements of any size in a compressible neo-Hookean solid that has the same moduli at small strain:
  /// energy μ/2 (J^(−2/3) tr C − 3) + κ/2 (J − 1)², κ being the bulk modulus. Loads keep their direction.
  finite
};

/// The problem in CalculiX's input language: linear (C3D4) or quadratic tetrahedra (C3D10), as the tissue's, one
/// material and one set of elements per region, fixed nodes, nodal loads; displacements are printed with *NODE PRINT,
/// which keeps seven digits. CalculiX has no averaged nodal pressure.
/// @param tissue of linear or quadratic tetrahedra
/// @param f [N] (3 × displacement nodes)
std::string calculix_deck(const Tissue& tissue, const VecX& f, Geometry geometry = Geometry::linear);

/// Displacements of the same mesh, materials, supports and loads by CalculiX [mm] (3 × displacement nodes), with one
/// thread, in a folder of its own under the system's folder for temporary files.
/// Errors: failed, when ccx is not there, does not end well, or leaves a displacement out.
Result<VecX> solve_with_calculix(const Tissue& tissue, const VecX& f);

/// A moment of a load that grows.
struct LoadedMoment {
  double share = 0.0;  ///< of the whole load
  VecX u;              ///< [mm] (3 × displacement nodes)
};

/// Displacements of a neo-Hookean solid (Geometry::finite) while the load grows, in the increments that CalculiX chose.
/// The last one has less than the whole load where no further equilibrium was found.
/// Errors: failed, when ccx is not there or found no increment.
Result<std::vector<LoadedMoment>> load_with_calculix(const Tissue& tissue, const VecX& f);

}  // namespace stylet::validate
