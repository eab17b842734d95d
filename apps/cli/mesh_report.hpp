// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/mesher/mesher.hpp"

namespace stylet::cli {

/// Report of a mesh that was not made here: its volumes are the input's, its surfaces coincide with the input's.
MeshReport report_as_is(const TetMesh& mesh);

/// What `stylet mesh` prints for people.
std::string report_text(const MeshReport& report);

/// What `stylet mesh --json` writes (docs/command_line.md).
Json report_json(const MeshReport& report);

}  // namespace stylet::cli
