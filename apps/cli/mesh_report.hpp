// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/mesher/mesher.hpp"

namespace stylet::cli {

/// What `stylet mesh` prints for people.
std::string report_text(const MeshReport& report);

/// What `stylet mesh --json` writes (docs/command_line.md).
Json report_json(const MeshReport& report);

}  // namespace stylet::cli
