// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/surface.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <filesystem>
#include <optional>

namespace stylet {

struct MeshReadOptions {
  double scale = 0.0;  ///< file unit in mm; 0 = the file's own unit if it states one, else 1 (a wrong unit is refused)
  std::vector<std::string>* notes = nullptr;  ///< receives what was passed over or put right, in words for the user
};

/// Reads tetrahedra: VTU, legacy VTK, gmsh MSH 1, 2.2 and 4.1 (ASCII, binary), MEDIT .mesh, TetGen .node/.ele. Other
/// elements in the file are passed over. Regions come from the format's own tag (physical group, reference, attribute,
/// cell array "region"), inverted numbering of whole files is put right, the result has passed check_mesh().
Result<TetMesh> read_tet_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// A named array beside the mesh in a VTU file: 1, 3 or 6 components per node or element.
struct MeshField {
  std::string name;  ///< with unit, e.g. "displacement_mm"
  MatX values;       ///< (components × nodes) or (components × tets)
};

/// Writes VTU (zlib, appended) with cell array "region", region names as field data, units in the array names.
/// The file appears whole or not at all.
Result<> write_vtu(const TetMesh& mesh, const std::filesystem::path& path,
                   const std::vector<MeshField>& node_fields = {}, const std::vector<MeshField>& tet_fields = {});

/// Reads triangulated surfaces: STL, PLY, OBJ, VTP, GLB (metres, y up → LPS mm; one surface per named node).
Result<std::vector<Surface>> read_surfaces(const std::filesystem::path& path, const MeshReadOptions& options = {});

}  // namespace stylet
