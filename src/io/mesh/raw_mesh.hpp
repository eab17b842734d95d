// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/wire.hpp"
#include "stylet/io/mesh_io.hpp"

#include <cstdint>
#include <map>
#include <optional>

namespace stylet::detail {

/// A named array of a mesh file with numbers of its cells, which may be the regions.
struct CellArray {
  std::string name;
  std::vector<double> values;        ///< (tets); empty if the array is not one number for each cell
  std::map<int, std::string> names;  ///< names of its numbers, if the file has them
};

/// A tetrahedral mesh as stored in a file, before units, numbering and regions are converted.
struct RawMesh {
  std::vector<Vec3> nodes;                   ///< [file unit]
  std::vector<std::array<Index, 4>> tets;    ///< into `nodes`
  std::vector<CellArray> arrays;             ///< arrays that may be the regions
  std::optional<std::size_t> own;            ///< the one of them that the format has for its regions
  std::string array_word = "cell array";     ///< word for such an array in messages
  std::vector<std::int64_t> cells;           ///< (tets) number of the cell in the file, for messages; may be empty
  std::string cell_word = "cell";            ///< word before such a number: "cell", "line"
  std::vector<int> tag;                      ///< (tets) region number, by choose_regions()
  std::map<int, std::string> tag_names;      ///< names of region numbers, by choose_regions()
  std::vector<bool> used_elsewhere;          ///< (nodes) whether an element other than tetrahedra uses it; may be empty
  std::map<std::string, Index> passed_over;  ///< number of ignored elements of each kind other than tetrahedra
  bool quadratic = false;                    ///< the file has quadratic tetrahedra, of which the corner nodes are used
  bool ras = false;                          ///< the file states that its frame is RAS
  double unit_mm = 0.0;                      ///< [mm] per file unit if the file states it, else 0
};

/// Sets the region numbers of a mesh: from the array that the user names; else from the format's own, where it divides
/// the mesh or names its region; else from the only array whose whole numbers can be regions, with a note. Arrays with
/// the same borders count once. A mesh that becomes one region without a name gets a note that lists the arrays.
/// @param wanted name of the array (upper and lower case count as equal); empty: none is named
/// Errors: no array of this name; the chosen array, or the format's own, is not one whole number per cell.
Result<> choose_regions(RawMesh& raw, const std::string& wanted, const std::string& source,
                        std::vector<std::string>& notes);

/// Converts a raw mesh: chooses the regions, scales to mm, converts RAS to LPS, drops nodes that only ignored elements
/// use, inverts all tetrahedra if all volumes are negative, and names the regions. The result has passed check_mesh().
Result<MeshWithNotes> finish_mesh(RawMesh raw, const std::string& source, const MeshReadOptions& options);

Result<RawMesh> parse_vtk_mesh(const std::filesystem::path& path, bool xml);
Result<RawMesh> parse_gmsh_mesh(const std::filesystem::path& path, bool medit);
Result<RawMesh> parse_tetgen_mesh(const std::filesystem::path& path);

/// Checks the length of a file's unit that the user has given.
Result<> check_scale(double scale);

}  // namespace stylet::detail
