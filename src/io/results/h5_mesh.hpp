// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "h5.hpp"
#include "stylet/geom/tet_mesh.hpp"

namespace stylet::h5 {

/// Writes the group "mesh": nodes_mm (n, 3), tets (m, 4), tet_region (m), regions, and the surfaces where it has any.
void write_mesh(hid_t file, const TetMesh& mesh);

/// Reads the group "mesh". Throws Failure if an array has another shape. The mesh is not checked (check_mesh()).
TetMesh read_mesh(hid_t file);

}  // namespace stylet::h5
