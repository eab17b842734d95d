// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the content of pictures without drawing them; drawing is part of the tests of the result folder.
#include "pictures/shapes.hpp"
#include "pictures/stage.hpp"
#include "pictures/views.hpp"
#include "report/moments.hpp"
#include "synthetic_run.hpp"

#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCamera.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

using namespace stylet;
using namespace stylet::results;
using stylet::testing::recording_of;
using stylet::testing::synthetic_run;

namespace {

/// Prepares every kind of picture of a run. @return total number of actors
int stage_all(const RunRecording& run) {
  const auto regions = region_views(run.mesh, run.info.target_regions);
  const Frame& frame = run.frames[find_moments(run.frames).deepest];
  const auto surfaces = shown_surfaces(run.mesh, regions);
  const PictureInput input{run, regions, surfaces, frame};
  int actors = 0;
  for (const Section& section : {sagittal_section(input), transverse_section(input)}) {
    for (const Layers& layers : {view_section(input, frame, section), view_displacement(input, frame, section)}) {
      for (const auto& layer : layers) actors += layer->GetActors()->GetNumberOfItems();
    }
  }
  for (const auto& layer : view_3d(input, frame)) actors += layer->GetActors()->GetNumberOfItems();
  return actors;
}

}  // namespace

TEST(PictureViews, sections_are_seen_as_in_radiology) {
  const auto run = recording_of(synthetic_run());
  const auto regions = region_views(run.mesh, run.info.target_regions);
  const auto surfaces = shown_surfaces(run.mesh, regions);
  const PictureInput input{run, regions, surfaces, run.frames[find_moments(run.frames).deepest]};
  const Section sagittal = sagittal_section(input), transverse = transverse_section(input);
  EXPECT_EQ(sagittal.view.right(), Vec3::UnitY());    // posterior at the right, head up
  EXPECT_EQ(transverse.view.right(), Vec3::UnitX());  // the patient's left at the right, front up
  EXPECT_EQ(transverse.view.up, -Vec3::UnitY());
  EXPECT_EQ(sagittal.origin, input.deepest.needle.back());
  EXPECT_NEAR(transverse.origin.z(), 62 + run.summary->target_shift_centroid_mm.z(), 3);
}

/// [mm²] Area of a flat picture's polygons.
double area_of(vtkPolyData* data) {
  double area = 0.0;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c) {
    vtkCell* cell = data->GetCell(c);
    const auto corner = [&](vtkIdType k) {
      Vec3 x;
      data->GetPoint(cell->GetPointId(static_cast<int>(k)), x.data());
      return x;
    };
    for (vtkIdType k = 2; k < cell->GetNumberOfPoints(); ++k)
      area += 0.5 * (corner(k - 1) - corner(0)).cross(corner(k) - corner(0)).norm();
  }
  return area;
}

TEST(PictureViews, a_section_fills_the_surfaces_of_the_structures_with_those_that_come_first_on_top) {
  auto made = synthetic_run();
  // Hollow octahedra of growing size round one point: a section through it fills squares with a square hole.
  const Vec3 middle(0, 0, 60), aside(0.7, 0.4, 60);
  const auto reach_mm = [](std::size_t region) { return 10.0 + 2.0 * static_cast<double>(region); };
  for (std::size_t r = 0; r < made.mesh.regions.size(); ++r) {
    Surface s{.name = made.mesh.regions[r], .points = {}, .triangles = {}};
    for (int k = 0; k < 3; ++k) {
      for (const double side : {1.0, -1.0}) s.points.emplace_back(middle + side * reach_mm(r) * Vec3::Unit(k));
    }
    s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int n = 0; n < 6; ++n) s.points.emplace_back(aside + 0.5 * (s.points[static_cast<std::size_t>(n)] - middle));
    for (int t = 0; t < 8; ++t) {  // a cavity of half the size
      const auto [a, b, c] = s.triangles[static_cast<std::size_t>(t)];
      s.triangles.push_back({a + 6, c + 6, b + 6});
    }
    made.mesh.surfaces.push_back(s);
  }
  const auto run = recording_of(made);
  const auto regions = region_views(run.mesh, run.info.target_regions);
  const auto surfaces = shown_surfaces(run.mesh, regions);
  Frame at_rest = run.frames.front();
  at_rest.displacement.setZero();
  at_rest.needle.clear();
  const PictureInput input{run, regions, surfaces, at_rest};
  const Section section{.view = {-Vec3::UnitZ(), -Vec3::UnitY()}, .origin = middle};
  std::vector<double> heights, areas;
  for (const auto& layer : view_section(input, at_rest, section)) {
    vtkActorCollection* actors = layer->GetActors();
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor()) {
      auto* data = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput());
      if (data == nullptr || data->GetNumberOfPolys() == 0) continue;
      heights.push_back(Vec3(actor->GetPosition()).dot(section.view.towards_viewer));
      areas.push_back(area_of(data));
    }
  }
  ASSERT_GE(areas.size(), regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    EXPECT_NEAR(areas[r], 1.5 * reach_mm(r) * reach_mm(r), 0.01 * areas[r]) << regions[r].name;
    if (r > 0) {
      EXPECT_LT(heights[r], heights[r - 1]) << regions[r].name;
    }
  }
}

TEST(PictureViews, a_framing_holds_all_points) {
  const Viewpoint view{Vec3::UnitX(), Vec3::UnitZ()};
  const std::vector<Vec3> points{{0, -40, 10}, {5, 60, 30}, {0, 0, -20}};
  const Area area{0.1, 0.1, 0.9, 0.9};
  const Framing framing = frame_points(points, view, area, 0.0);
  const double half_width = framing.half_height * area.width() / area.height();
  for (const Vec3& p : points) {
    EXPECT_LE(std::abs((p - framing.centre).dot(view.right())), half_width * (1 + 1e-12));
    EXPECT_LE(std::abs((p - framing.centre).dot(view.up)), framing.half_height * (1 + 1e-12));
  }
  EXPECT_DOUBLE_EQ(half_width, 50);  // not larger than necessary
}

TEST(PictureViews, runs_without_needle_target_or_organs_can_be_staged) {
  auto usual = synthetic_run();
  EXPECT_GT(stage_all(recording_of(usual)), 20);
  auto no_needle = usual;
  for (Frame& frame : no_needle.frames) frame.needle.clear();
  EXPECT_GT(stage_all(recording_of(no_needle)), 20);
  auto no_target = usual;
  no_target.info.target_regions.clear();
  EXPECT_GT(stage_all(recording_of(no_target)), 20);
  auto one_region = usual;
  one_region.mesh.regions = {"tissue"};
  std::fill(one_region.mesh.tet_region.begin(), one_region.mesh.tet_region.end(), 0);
  one_region.info.target_regions = {0};
  EXPECT_GT(stage_all(recording_of(one_region)), 5);
  auto no_motion = usual;
  for (Frame& frame : no_motion.frames) frame.displacement.setZero();
  EXPECT_GT(stage_all(recording_of(no_motion)), 20);
}

TEST(PictureViews, round_numbers_are_one_two_or_five) {
  EXPECT_DOUBLE_EQ(round_down(0.37), 0.2);
  EXPECT_DOUBLE_EQ(round_down(7), 5);
  EXPECT_DOUBLE_EQ(round_down(19.99), 10);
  EXPECT_DOUBLE_EQ(round_down(100), 100);
}
