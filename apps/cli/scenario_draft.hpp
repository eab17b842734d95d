// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/input.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet::cli {

/// The source of the patient of a drafted scenario.
struct DraftSource {
  std::string file;                  ///< file name that the user gave
  std::string source;                ///< value of patient.source in the scenario
  double scale = 0.0;                ///< [mm] unit of a mesh file; 0: the file's own
  int volume = 0;                    ///< volume of a mask file with several, counted from 1; 0: the only one
  std::string regions_from{};        ///< array of a mesh file that is its regions; empty: as the file says
  std::vector<std::string> skip;     ///< structures or labels that the user leaves out
  std::vector<std::string> notes{};  ///< of the reader, for comments
};

/// patient.source for a scenario that is written to `output`. The path is relative to the scenario's folder, so that
/// both can be moved together; it is absolute if `output` is empty, because the folder is not known then.
std::string source_for(const std::filesystem::path& file, const std::filesystem::path& output);

struct ScenarioDraft {
  std::string text;                   ///< TOML, without the last line end
  std::vector<std::string> warnings;  ///< reasons why the scenario may not run without changes
};

/// Drafts a commented scenario: the region of each structure, the structures that are left out and why, and one needle.
Result<ScenarioDraft> draft_scenario(const PatientInput& patient, const DraftSource& source);

}  // namespace stylet::cli
