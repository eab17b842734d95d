// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/surface.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

struct MeshReadOptions {
  double scale = 0.0;  ///< [mm] length of one unit of the file's coordinates; 0 = the unit that the file states, or
                       ///< 1 mm (checked for plausibility) if it states none
  std::vector<std::string>* notes = nullptr;  ///< receives sentences for the user about ignored or corrected data
  std::string regions_from{};  ///< name of the cell array (VTU, VTK), $ElementData (gmsh) or "attribute N" (TetGen)
                               ///< that is the regions; empty = the format's own, else the only array that can be them
};

/// Reads tetrahedra: VTU, legacy VTK, gmsh MSH 1, 2.2 and 4.1 (ASCII, binary), MEDIT .mesh, TetGen .node/.ele. Other
/// elements in the file are ignored. Regions come from the format's own tag (physical group, reference, attribute, cell
/// array "region"); where these do not divide the mesh, from the only array of whole numbers that does, with a note. If
/// the node order of all tetrahedra of a file gives negative volumes, the order is reversed. The result has passed
/// check_mesh(). Errors: a damaged file, `regions_from` that names no array of one whole number per cell.
Result<TetMesh> read_tet_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// A named array for the nodes or elements of a VTU file, with 1, 3 or 6 components each.
struct MeshField {
  std::string name;  ///< with unit, e.g. "displacement_mm"
  MatX values;       ///< (components × nodes) or (components × tets)
};

/// Writes a VTU file (zlib, appended) with the cell array "region", region names as field data, and units in the array
/// names. On error no incomplete file is left.
Result<> write_vtu(const TetMesh& mesh, const std::filesystem::path& path,
                   const std::vector<MeshField>& node_fields = {}, const std::vector<MeshField>& tet_fields = {});

/// Reads triangulated surfaces: STL, PLY, OBJ, VTP, GLB (metres, y up → LPS mm; one surface per named node).
Result<std::vector<Surface>> read_surfaces(const std::filesystem::path& path, const MeshReadOptions& options = {});

}  // namespace stylet
