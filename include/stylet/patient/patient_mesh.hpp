// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet {

/// Makes the tetrahedral mesh of a scenario's patient. Contours and masks are meshed, a mesh is taken as it is, and the
/// source "phantom" is the demo patient.
/// @param scenario its patient.source is a path from the current folder, or "phantom"
/// @return mesh [mm, LPS] with named regions, and a report with notes for the user
/// Errors: a file that is missing, damaged or without a patient to mesh; each error names the file and the cure.
Result<MeshedAnatomy> mesh_patient(const Scenario& scenario, const Progress& progress = {});

/// Takes a mesh that was made elsewhere: renames its regions and reports its quality. In the report the input volumes
/// equal the mesh volumes.
/// @param names name in the file, or N for "region N" → name in the model; regions to which this gives the same
///   name become one
/// @param where name of the file in error messages
Result<MeshedAnatomy> take_mesh(TetMesh mesh, const std::map<std::string, std::string>& names,
                                const std::string& where);

}  // namespace stylet
