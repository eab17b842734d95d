// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/input.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet::cli {

/// Where a drafted scenario finds its patient.
struct DraftSource {
  std::string file;               ///< as the user named it
  std::string source;             ///< patient.source, as it is to stand in the scenario
  double scale = 0.0;             ///< unit of a mesh file [mm]; 0 = as the file says
  int volume = 0;                 ///< of a mask file that holds several, counted from 1; 0 = the only one
  std::vector<std::string> skip;  ///< structures or labels that the user leaves out
};

/// patient.source for a scenario that is written to `output`: relative to its folder, so that the two can be moved
/// together; absolute where `output` is empty, since nobody knows where standard output goes.
std::string source_for(const std::filesystem::path& file, const std::filesystem::path& output);

struct ScenarioDraft {
  std::string text;                   ///< TOML, without the last line end
  std::vector<std::string> warnings;  ///< why it may not run as it is
};

/// A scenario to start from, with comments: what is taken as what, what is left out and why, and one needle.
Result<ScenarioDraft> draft_scenario(const PatientInput& patient, const DraftSource& source);

}  // namespace stylet::cli
