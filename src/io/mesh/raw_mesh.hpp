// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/wire.hpp"
#include "stylet/io/mesh_io.hpp"

#include <map>

namespace stylet::detail {

/// A tetrahedral mesh as a file holds it, before units, numbering and regions are put in order.
struct RawMesh {
  std::vector<Vec3> nodes;                   ///< [file unit]
  std::vector<std::array<Index, 4>> tets;    ///< into `nodes`
  std::vector<int> tag;                      ///< (tets) region number of the file
  std::map<int, std::string> tag_names;      ///< names of region numbers, where the file gives them
  std::vector<bool> used_elsewhere;          ///< (nodes) belongs to an element that is no tetrahedron; may be empty
  std::map<std::string, Index> passed_over;  ///< elements that are no tetrahedra, count by kind
  bool quadratic = false;                    ///< corner nodes were taken of quadratic tetrahedra
  bool ras = false;                          ///< the file says its frame is RAS
  double unit_mm = 0.0;                      ///< [mm] per file unit if the file states it, else 0
};

/// Scales to mm, turns RAS into LPS, drops nodes that only other elements use, makes all volumes positive when all are
/// negative, names the regions, and lets check_mesh() judge.
Result<MeshWithNotes> finish_mesh(RawMesh raw, const std::string& source, const MeshReadOptions& options);

Result<RawMesh> parse_vtk_mesh(const std::filesystem::path& path, bool xml);
Result<RawMesh> parse_gmsh_mesh(const std::filesystem::path& path, bool medit);
Result<RawMesh> parse_tetgen_mesh(const std::filesystem::path& path);

/// Checks the factor a user gives for a file's unit.
Result<> check_scale(double scale);

}  // namespace stylet::detail
