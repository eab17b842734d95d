// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/file_kind.hpp"
#include "detail/wire.hpp"
#include "stylet/io/mesh_io.hpp"

#include <vtkPolyData.h>

namespace stylet::detail {

/// STL, PLY, OBJ, VTP: one surface, named after the file.
Result<SurfacesWithNotes> parse_surface(const std::filesystem::path& path, FileKind kind, double scale);

/// GLB: one surface per node with triangles, named as the node; metres, y up → LPS mm.
Result<SurfacesWithNotes> parse_glb(const std::filesystem::path& path, double scale);

/// Triangles of polygons and strips; points as they are, faces that are no triangles fanned.
Surface to_surface(vtkPolyData& data, std::string name);

/// Joins points that coincide, drops triangles without area and surfaces without triangles, turns a closed surface's
/// normals outward; refuses NaN, nothing left, and an extent of the whole that betrays wrong units (< 1 mm or > 2 m).
Result<SurfacesWithNotes> finish_surfaces(std::vector<Surface> surfaces, const std::string& source);

}  // namespace stylet::detail
