// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace stylet::test {

/// A box of 40 × 30 × 30 mm in two regions, "gland" below and "body" above, 90 to 200 tetrahedra.
TetMesh two_region_box();

/// The mesh in every format read, written without Stylet: by gmsh, or as text by hand. TetGen's partner file lies
/// beside.
struct MeshFile {
  std::string what;
  std::filesystem::path path;
  bool names;  ///< the format carries region names
};
std::vector<MeshFile> write_all_formats(const TetMesh& mesh, const std::filesystem::path& folder);

// The text formats by hand, for tests that change a piece.
std::string msh22_text(const TetMesh& mesh);
std::string vtk_text(const TetMesh& mesh);
std::pair<std::string, std::string> tetgen_texts(const TetMesh& mesh, int first = 1);  ///< .node, .ele

}  // namespace stylet::test
