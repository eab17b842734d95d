// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/file_kind.hpp"
#include "detail/wire.hpp"
#include "stylet/io/mesh_io.hpp"

#include <vtkPolyData.h>

namespace stylet::detail {

/// Reads STL, PLY, OBJ or VTP: one surface, named after the file.
Result<SurfacesWithNotes> parse_surface(const std::filesystem::path& path, FileKind kind, double scale);

/// Reads GLB: one surface per node with triangles, named as the node; converts metres, y up → LPS mm.
Result<SurfacesWithNotes> parse_glb(const std::filesystem::path& path, double scale);

/// Converts polygons and strips to triangles: points stay unchanged, faces with more than three corners become fans.
/// Error: a triangle refers to a point that is not there.
/// @param source name of the file, for messages
Result<Surface> to_surface(vtkPolyData& data, std::string name, const std::string& source);

/// Cleans surfaces: merges coincident points, drops triangles without area and surfaces without triangles, and turns
/// the normals of closed surfaces outward. Errors: NaN; nothing left; a total extent that indicates wrong units (< 1 mm
/// or > 2 m).
Result<SurfacesWithNotes> finish_surfaces(std::vector<Surface> surfaces, const std::string& source);

}  // namespace stylet::detail
