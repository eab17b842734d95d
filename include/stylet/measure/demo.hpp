// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/mesher/mesher.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "stylet/sim/scenario.hpp"

#include <memory>
#include <vector>

namespace stylet::measure {

/// The demo scenario of scenarios/demo.toml: one needle through hole e3.5 of the demo patient, whose pelvic side walls
/// are held. Benchmarks and comparisons change single settings of it.
Scenario demo_scenario();

/// Meshes the demo patient in the way the demo scenario asks for.
/// @param nodes about how many nodes the mesh gets
Result<MeshedAnatomy> mesh_demo(Index nodes, const Progress& progress);

/// The demo patient with a probe in the rectum, as tissue without a needle.
struct ProbedDemo {
  std::unique_ptr<const Tissue> tissue;
  std::unique_ptr<const Topology> topology;
  std::vector<int> gland;  ///< regions that form the gland

  [[nodiscard]] PatientProbe::Patient patient() const { return {*tissue, *topology, gland}; }
};

/// Meshes and factorises the demo patient; the lumen is soft, as in every scenario with a probe.
/// @param nodes about how many nodes the mesh gets
Result<ProbedDemo> probed_demo(Index nodes, const Progress& progress = {});

}  // namespace stylet::measure
