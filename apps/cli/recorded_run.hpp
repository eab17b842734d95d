// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/recording_io.hpp"
#include "stylet/patient/prepared_model.hpp"

#include <span>
#include <string>
#include <vector>

namespace stylet::cli {

/// A recording that is to be repeated, and its model.
struct RecordedRun {
  std::vector<Step> steps;
  PreparedModel prepared;
};

/// Reads a run.h5 and compiles its scenario for its mesh.
/// @param settings arguments of --set; with these the recorded motion of the hand moves another needle or tissue
Result<RecordedRun> recorded_run(const std::string& file, const std::vector<std::string>& settings,
                                 const Progress& progress);

/// Compares the forces of a repeated run with the recorded forces, bit by bit. @return the result in words
std::string compare_forces(std::span<const Step> recorded, std::span<const Step> repeated);

}  // namespace stylet::cli
