// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/shapes.hpp"
#include "pictures/views.hpp"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataSilhouette.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

namespace stylet::results {
namespace {

/// Points that the picture has to show: the organs, the entry and the deepest tip.
std::vector<Vec3> places_of_interest(const PictureInput& input) {
  const bool only_background = input.regions.size() == 1;
  std::vector<Vec3> places;
  const VecX at_rest = VecX::Zero(3 * input.run.mesh.node_count());
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    if (input.regions[r].background && !only_background) continue;
    const std::vector<Vec3> points = input.surfaces[r].positions(input.run.mesh, at_rest);
    for (const auto& t : input.surfaces[r].triangles) {
      for (const Index n : t) places.push_back(points[static_cast<std::size_t>(n)]);
    }
  }
  const Vec3& entry = input.run.info.entry_mm;
  places.push_back(entry);
  places.push_back(entry - 12 * input.run.info.direction);
  if (!input.deepest.needle.empty()) places.push_back(input.deepest.needle.back());
  return places;
}

}  // namespace

Viewpoint oblique_viewpoint() {
  Viewpoint view;
  view.towards_viewer = Vec3(0.80, -0.56, 0.20).normalized();
  view.up = (Vec3::UnitZ() - Vec3::UnitZ().dot(view.towards_viewer) * view.towards_viewer).normalized();
  return view;
}

Layers view_3d(const PictureInput& input, const Frame& frame) {
  const Viewpoint viewpoint = oblique_viewpoint();
  const Area area;
  const Framing framing = frame_points(places_of_interest(input), viewpoint, area);
  const auto stage = make_stage(viewpoint, framing, area);
  stage->UseDepthPeelingOn();
  stage->SetMaximumNumberOfPeels(16);
  stage->SetOcclusionRatio(0.0);
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    const RegionView& view = input.regions[r];
    const auto surface = moved(input.surfaces[r], input.run.mesh, frame.displacement);
    vtkActor* actor = add_surface(stage, with_normals(surface), view.colour, view.opacity);
    actor->GetProperty()->BackfaceCullingOn();  // as in the interactive view
    if (view.soft_layer) continue;
    vtkNew<vtkPolyDataSilhouette> silhouette;
    silhouette->SetInputData(surface);
    silhouette->SetCamera(stage->GetActiveCamera());
    silhouette->SetEnableFeatureAngle(0);
    silhouette->BorderEdgesOff();
    silhouette->Update();
    vtkActor* outline = add_lines(stage, silhouette->GetOutput(), lighter(view.colour, -0.35), 1.5);
    outline->GetProperty()->SetOpacity(view.background ? 0.25 : 0.5);
  }
  if (frame.needle.size() >= 2) {
    vtkActor* needle = add_surface(stage, needle_tube(frame.needle, input.run.info.needle_diameter_mm), kSteel, 1.0);
    needle->GetProperty()->SetSpecular(0.6);
  }
  add_scale_bar(stage, framing, area);
  return {stage, orientation_cube(viewpoint)};
}

}  // namespace stylet::results
