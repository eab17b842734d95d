// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/geom/tied_surface.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/sim/recording.hpp"

#include <vtkSmartPointer.h>

#include <span>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

/// Conversion of the anatomy and the needle of one frame to VTK data, [mm] LPS.
namespace stylet::results {

/// The tetrahedra with cell array "region" and point array "displacement_mm" (magnitude), deformed.
vtkSmartPointer<vtkUnstructuredGrid> deformed_grid(const TetMesh& mesh, const VecX& displacement);

/// The surfaces that pictures show, in the order of `regions`: as the structures were given, or the faces of the
/// elements where a mesh has no such surfaces.
std::vector<TiedSurface> shown_surfaces(const TetMesh& mesh, std::span<const RegionView> regions);

/// A surface with its points moved by the displacement [mm] (3 × nodes) of the mesh.
vtkSmartPointer<vtkPolyData> moved(const TiedSurface& surface, const TetMesh& mesh, const VecX& displacement);
/// A surface with normals for smooth shading; points on sharp edges are duplicated, one for each side.
vtkSmartPointer<vtkPolyData> with_normals(vtkPolyData* surface);

/// A tube of the needle's diameter along its centreline, closed, with a conical tip one diameter long.
vtkSmartPointer<vtkPolyData> needle_tube(std::span<const Vec3> centreline, double diameter);

/// The centreline as one polyline.
vtkSmartPointer<vtkPolyData> polyline(std::span<const Vec3> points);

}  // namespace stylet::results
