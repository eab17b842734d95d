// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet::cli {

/// The tetrahedra of a scenario's patient: contours and masks are meshed, a mesh is taken as it is, "phantom" is the
/// demo patient.
/// @param where what to call the scenario in messages
Result<MeshedAnatomy> patient_model(const Scenario& scenario, const std::string& where, const Progress& progress);

/// Gives regions of a mesh their canonical names.
/// @param names name in the file → name in the model
Result<> rename_regions(TetMesh& mesh, const std::map<std::string, std::string>& names, const std::string& where);

}  // namespace stylet::cli
