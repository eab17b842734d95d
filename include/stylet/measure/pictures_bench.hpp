// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/measure/scale_bench.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// Processor time of one kind of picture of the deformed demo patient on one mesh.
struct PictureRow {
  Index nodes = 0;
  std::string picture;  ///< "surfaces", "section", "ultrasound, transverse", "ultrasound, sagittal", "X-ray", "probe"
  StepTimes cpu_us;     ///< thread CPU time of a picture
  double prepare_s = 0.0;  ///< thread CPU time before the first picture
};

struct PicturesBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
};

/// Makes 60 pictures of each kind of the demo patient on meshes of 3,000 and 20,000 nodes. Surfaces with the needle's
/// near field and a section that turns about the needle are computed from the forces of an insertion with 40 contacts.
/// Ultrasound and X-ray show an assumed needle and 20 seeds in tissue that moves from picture to picture. "probe" is
/// the solve for the forces of an ultrasound probe that presses, at poses along the gland.
Result<std::vector<PictureRow>> bench_pictures(const PicturesBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
