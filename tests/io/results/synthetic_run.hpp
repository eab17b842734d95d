// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/sim/hole_map.hpp"
#include "stylet/sim/recording.hpp"

#include <array>
#include <vector>

namespace stylet::testing {

/// The input of a ResultsWriter during a run.
struct SyntheticRun {
  RunInfo info;
  TetMesh mesh;
  std::vector<Step> steps;
  std::vector<Frame> frames;
  Summary summary;
};

struct SyntheticOptions {
  std::array<int, 3> cells{8, 7, 9};  ///< cells of the box that contains the anatomy
  double step_s = 0.01;
  int frames = 8;  ///< number of regular frames, in addition to labelled ones
};

/// A synthetic insertion into ellipsoids in a box, computed by formulas without a simulation: approach, skin contact,
/// puncture, entry into the gland, deepest point, pause, a retraction that sticks and then slips, and withdrawal.
SyntheticRun synthetic_run(const SyntheticOptions& options = {});

/// The recording that a reader of the run's file would get. A map of the template's holes with all kinds of missing
/// data: hole D1 has no way, D7 has no prediction, and there is no rectum.
HoleMap synthetic_map();

/// The same map with needles in place before.
HoleMap synthetic_map_beside_needles();

RunRecording recording_of(const SyntheticRun& run);

}  // namespace stylet::testing
