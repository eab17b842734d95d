// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/wire.hpp"
#include "stylet/io/mesh_io.hpp"

#include <map>

namespace stylet::detail {

/// A tetrahedral mesh as stored in a file, before units, numbering and regions are converted.
struct RawMesh {
  std::vector<Vec3> nodes;                   ///< [file unit]
  std::vector<std::array<Index, 4>> tets;    ///< into `nodes`
  std::vector<int> tag;                      ///< (tets) region number of the file
  std::map<int, std::string> tag_names;      ///< names of region numbers, if the file has them
  std::vector<bool> used_elsewhere;          ///< (nodes) whether an element other than tetrahedra uses it; may be empty
  std::map<std::string, Index> passed_over;  ///< number of ignored elements of each kind other than tetrahedra
  bool quadratic = false;                    ///< the file has quadratic tetrahedra, of which the corner nodes are used
  bool ras = false;                          ///< the file states that its frame is RAS
  double unit_mm = 0.0;                      ///< [mm] per file unit if the file states it, else 0
};

/// Converts a raw mesh: scales to mm, converts RAS to LPS, drops nodes that only ignored elements use, inverts all
/// tetrahedra if all volumes are negative, and names the regions. The result has passed check_mesh().
Result<MeshWithNotes> finish_mesh(RawMesh raw, const std::string& source, const MeshReadOptions& options);

Result<RawMesh> parse_vtk_mesh(const std::filesystem::path& path, bool xml);
Result<RawMesh> parse_gmsh_mesh(const std::filesystem::path& path, bool medit);
Result<RawMesh> parse_tetgen_mesh(const std::filesystem::path& path);

/// Checks the length of a file's unit that the user has given.
Result<> check_scale(double scale);

}  // namespace stylet::detail
