// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/sim/recording.hpp"

#include <vtkSmartPointer.h>

#include <span>

class vtkPoints;
class vtkPolyData;
class vtkUnstructuredGrid;

/// Conversion of the anatomy and the needle of one frame to VTK data, [mm] LPS.
namespace stylet::results {

/// Node positions moved by `displacement` [mm] (3n).
vtkSmartPointer<vtkPoints> deformed_points(const TetMesh& mesh, const VecX& displacement);

/// The tetrahedra with cell array "region" and point array "displacement_mm" (magnitude), deformed.
vtkSmartPointer<vtkUnstructuredGrid> deformed_grid(const TetMesh& mesh, const VecX& displacement);

/// A region's surface on given points.
vtkSmartPointer<vtkPolyData> region_surface(const RegionView& view, vtkPoints* points);
/// A surface with normals for smooth shading; points on sharp edges are duplicated, one for each side.
vtkSmartPointer<vtkPolyData> with_normals(vtkPolyData* surface);

/// A tube of the needle's diameter along its centreline, closed, with a conical tip one diameter long.
vtkSmartPointer<vtkPolyData> needle_tube(std::span<const Vec3> centreline, double diameter);

/// The centreline as one polyline.
vtkSmartPointer<vtkPolyData> polyline(std::span<const Vec3> points);

}  // namespace stylet::results
