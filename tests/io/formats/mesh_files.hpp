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

/// The mesh in every readable format, written without Stylet: by gmsh, or as text by the test. The second file of
/// TetGen is in the same folder.
struct MeshFile {
  std::string what;
  std::filesystem::path path;
  bool names;  ///< the format has region names
};
std::vector<MeshFile> write_all_formats(const TetMesh& mesh, const std::filesystem::path& folder);

// Text formats written by the test, for tests that change a part of them.
std::string msh22_text(const TetMesh& mesh);
std::string vtk_text(const TetMesh& mesh);
std::pair<std::string, std::string> tetgen_texts(const TetMesh& mesh, int first = 1);  ///< .node, .ele

}  // namespace stylet::test
