// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/measure/timing.hpp"
#include "stylet/probe/patient_probe.hpp"

#include <memory>
#include <vector>

namespace stylet::measure {

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

/// A probe that moves in the demo patient, on one mesh.
struct ProbeRow {
  Index nodes = 0;
  int points = 0;                                                  ///< areas of the wall
  long poses = 0;                                                  ///< number of poses
  double pose_p50_ms = 0.0, pose_p99_ms = 0.0, pose_max_ms = 0.0;  ///< thread CPU time of ProbeContact::press()
  double field_p50_ms = 0.0;                                       ///< of the displacement of all nodes
  double prepare_s = 0.0;       ///< wall-clock time of the wall's compliance, without mesh and factor
  double megabytes = 0.0;       ///< memory of the compliance
  double force_N = 0.0;         ///< anterior-posterior, at a lift of 8 mm with the array at the gland's base
  double penetration_mm = 0.0;  ///< largest of all poses
};

struct ProbeBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
};

/// Moves a probe in the demo patient on meshes of 3,000, 5,000, 10,000, 20,000 and 40,000 nodes: in along the rectum,
/// up by 10 mm, out and down, 0.25 mm from pose to pose, which is 15 mm/s at 60 poses per second.
Result<std::vector<ProbeRow>> bench_probe(const ProbeBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
