// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/mesher/mesher.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet::measure {

/// The demo scenario of scenarios/demo.toml: one needle through hole e3.5 of the demo patient, whose pelvic side walls
/// are held. Benchmarks and comparisons change single settings of it.
Scenario demo_scenario();

/// Meshes the demo patient in the way the demo scenario asks for.
/// @param nodes about how many nodes the mesh gets
Result<MeshedAnatomy> mesh_demo(Index nodes, const Progress& progress);

}  // namespace stylet::measure
