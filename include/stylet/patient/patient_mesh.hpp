// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet {

/// The tetrahedra of a scenario's patient. Contours and masks are meshed, a mesh is taken as it is, and the source
/// "phantom" is the demo patient.
/// @param scenario its patient.source is a path from the current folder, or "phantom"
/// @return mesh [mm, LPS] with named regions, and a report with notes for the user
/// Errors: a file that is missing, broken or has no patient to mesh; each names the file and the cure.
Result<MeshedAnatomy> mesh_patient(const Scenario& scenario, const Progress& progress = {});

/// A mesh that was made elsewhere, with other names for its regions and a report of its quality. Its volumes are the
/// input's, and its surfaces coincide with the input's.
/// @param names name in the file → name in the model
/// @param where name of the file in error messages
Result<MeshedAnatomy> take_mesh(TetMesh mesh, const std::map<std::string, std::string>& names,
                                const std::string& where);

}  // namespace stylet
