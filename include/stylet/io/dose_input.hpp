// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet {

/// A file with its SHA-256, for DoseEvaluation::inputs. Of a folder the digest is that of the lines "DIGEST  NAME" of
/// its files, in the order of their names. A file that cannot be read has no digest.
/// @param role what the file is: "plan", "structures", …
DoseInput dose_input(const std::string& role, const std::filesystem::path& path);

/// The same for several files, each with its role. Those without a path, or that do not exist, are left out.
std::vector<DoseInput> dose_inputs(const std::vector<std::pair<std::string, std::string>>& files);

/// The present date and time of the computer's time zone, as "2024-01-31 14:05 +01:00".
std::string date_and_time();

}  // namespace stylet
