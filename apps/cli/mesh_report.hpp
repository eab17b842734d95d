// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/mesher/mesher.hpp"

namespace stylet::cli {

/// The text that `stylet mesh` prints.
std::string report_text(const MeshReport& report);

/// The JSON that `stylet mesh --json` writes (docs/command_line.md).
Json report_json(const MeshReport& report);

}  // namespace stylet::cli
