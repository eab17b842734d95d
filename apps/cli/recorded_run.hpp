// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/recording_io.hpp"
#include "stylet/patient/prepared_model.hpp"

#include <span>
#include <string>
#include <vector>

namespace stylet::cli {

/// A recording to be carried out again, and the model it was made with.
struct RecordedRun {
  std::vector<Step> steps;
  PreparedModel prepared;
};

/// Reads a run.h5 and compiles its scenario for its mesh.
/// @param settings of --set: with any, the same hand moves another needle or tissue
Result<RecordedRun> recorded_run(const std::string& file, const std::vector<std::string>& settings,
                                 const Progress& progress);

/// How the forces of a repeated run compare with the recorded ones, in words: to the last bit, or where not.
std::string compare_forces(std::span<const Step> recorded, std::span<const Step> repeated);

}  // namespace stylet::cli
