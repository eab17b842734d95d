// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/measure/scale_bench.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// Computing time of an ultrasound picture on one mesh.
struct ImageRow {
  std::string view;  ///< "transverse" or "sagittal"
  Index nodes = 0;
  int lines = 0;
  int samples = 0;
  StepTimes cpu_ms;       ///< thread CPU time of a whole picture: needle with its near field, 20 seeds, artefacts
  StepTimes lattice_ms;   ///< of the same picture with speckle alone: cut, lattice, beam, envelope, compression
  double set_up_s = 0.0;  ///< thread CPU time of the scanner's construction
};

struct ImageBenchOptions {
  Index nodes = 5000;
  int frames = 100;
};

/// Makes pictures of the demo patient around an assumed needle, in tissue that moves from picture to picture.
/// Errors: those of meshing the demo patient.
Result<std::vector<ImageRow>> bench_image(const ImageBenchOptions& options, const Progress& progress);

}  // namespace stylet::measure
