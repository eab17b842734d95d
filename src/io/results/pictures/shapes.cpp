// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/shapes.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>
#include <vtkTubeFilter.h>
#include <vtkUnstructuredGrid.h>

#include "stylet/geom/topology.hpp"

#include <algorithm>
#include <utility>

namespace stylet::results {

namespace {

/// Node positions moved by `displacement` [mm] (3n).
vtkSmartPointer<vtkPoints> deformed_points(const TetMesh& mesh, const VecX& displacement) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.node_count());
  for (Index n = 0; n < mesh.node_count(); ++n) {
    const Vec3 x = mesh.nodes[static_cast<std::size_t>(n)] + displacement.segment<3>(3 * n);
    points->SetPoint(n, x.data());
  }
  return points;
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> deformed_grid(const TetMesh& mesh, const VecX& displacement) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(deformed_points(mesh, displacement));
  grid->Allocate(mesh.tet_count());
  vtkNew<vtkIntArray> region;
  region->SetName("region");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::array<vtkIdType, 4> corners{mesh.tets[t][0], mesh.tets[t][1], mesh.tets[t][2], mesh.tets[t][3]};
    grid->InsertNextCell(VTK_TETRA, 4, corners.data());
    region->InsertNextValue(mesh.tet_region[t]);
  }
  vtkNew<vtkDoubleArray> magnitude;
  magnitude->SetName("displacement_mm");
  for (Index n = 0; n < mesh.node_count(); ++n) magnitude->InsertNextValue(displacement.segment<3>(3 * n).norm());
  grid->GetCellData()->AddArray(region);
  grid->GetPointData()->AddArray(magnitude);
  return grid;
}

std::vector<TiedSurface> shown_surfaces(const TetMesh& mesh, std::span<const RegionView> regions) {
  std::vector<TiedSurface> shown;
  if (!mesh.surfaces.empty()) {
    const Topology topology(mesh);
    std::vector<TiedSurface> tied = tie_surfaces(Locator(mesh, topology));
    for (const RegionView& view : regions) shown.push_back(std::move(tied[static_cast<std::size_t>(view.region)]));
    return shown;
  }
  for (const RegionView& view : regions) {
    TiedSurface faces{.region = view.region, .nodes = {}, .weights = {}, .triangles = view.triangles};
    for (Index n = 0; n < mesh.node_count(); ++n) faces.nodes.push_back({n, n, n, n});
    faces.weights.assign(mesh.nodes.size(), Vec4::UnitX());
    shown.push_back(std::move(faces));
  }
  return shown;
}

vtkSmartPointer<vtkPolyData> moved(const TiedSurface& surface, const TetMesh& mesh, const VecX& displacement) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& x : surface.positions(mesh, displacement)) points->InsertNextPoint(x.data());
  vtkNew<vtkCellArray> cells;
  for (const auto& t : surface.triangles) {
    const std::array<vtkIdType, 3> corners{t[0], t[1], t[2]};
    cells->InsertNextCell(3, corners.data());
  }
  auto faces = vtkSmartPointer<vtkPolyData>::New();
  faces->SetPoints(points);
  faces->SetPolys(cells);
  return faces;
}

vtkSmartPointer<vtkPolyData> with_normals(vtkPolyData* surface) {
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(surface);
  normals->ConsistencyOff();  // the triangles already have a consistent orientation
  normals->AutoOrientNormalsOff();
  normals->SetFeatureAngle(70);
  normals->Update();
  return normals->GetOutput();
}

vtkSmartPointer<vtkPolyData> polyline(std::span<const Vec3> points) {
  auto line = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(points.size()));
  for (const Vec3& p : points) cells->InsertCellPoint(places->InsertNextPoint(p.data()));
  line->SetPoints(places);
  line->SetLines(cells);
  return line;
}

vtkSmartPointer<vtkPolyData> needle_tube(std::span<const Vec3> centreline, double diameter) {
  // The conical tip is one diameter long: insert a point at its beginning and let the radius decrease to zero from
  // there.
  std::vector<Vec3> points(centreline.begin(), centreline.end());
  std::vector<double> radii(points.size(), diameter / 2);
  double left = diameter;
  while (points.size() > 2 && (points.back() - points[points.size() - 2]).norm() < left) {
    left -= (points.back() - points[points.size() - 2]).norm();
    points.pop_back();
    radii.pop_back();
  }
  const Vec3 tip = centreline.back();
  const Vec3 last = points.back();
  points.pop_back();
  radii.pop_back();
  const double last_length = (points.back() - last).norm();
  const Vec3 shoulder = last + (points.back() - last).normalized() * std::min(left, 0.9 * last_length);
  points.insert(points.end(), {shoulder, tip});
  radii.insert(radii.end(), {diameter / 2, diameter / 200});

  const auto line = polyline(points);
  vtkNew<vtkDoubleArray> radius;
  radius->SetName("radius_mm");
  for (const double r : radii) radius->InsertNextValue(r);
  line->GetPointData()->SetScalars(radius);
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputData(line);
  tube->SetVaryRadiusToVaryRadiusByAbsoluteScalar();
  tube->SetNumberOfSides(24);
  tube->CappingOn();
  tube->Update();
  vtkSmartPointer<vtkPolyData> surface = tube->GetOutput();
  surface->GetPointData()->SetScalars(nullptr);
  return surface;
}

}  // namespace stylet::results
