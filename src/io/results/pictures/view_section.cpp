// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/shapes.hpp"
#include "pictures/views.hpp"

#include <vtkActor.h>
#include <vtkCellData.h>
#include <vtkContourFilter.h>
#include <vtkContourTriangulator.h>
#include <vtkCutter.h>
#include <vtkDataArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRegularPolygonSource.h>
#include <vtkRenderer.h>
#include <vtkStripper.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace stylet::results {
namespace {

// Offsets of the layers towards the viewer [mm], which determine what covers what. Since the projection is parallel,
// they move nothing in the picture.
constexpr double kInitialLayer = 0.5, kOutlineLayer = 1.0, kRegionLayers = 30.0, kNeedleLayer = 60.0;

enum class Drawn { fill, outline_at_rest, outline };

/// The layer of a part of a region's drawing: all parts of a region that comes first lie on top of those of others.
double layer_of(Drawn part, std::size_t region, std::size_t regions) {
  const double below = static_cast<double>(regions - 1 - region) + static_cast<double>(part) / 3.0;
  return kRegionLayers * below / static_cast<double>(regions);
}

vtkSmartPointer<vtkPolyData> cut(vtkDataSet* data, const Section& section) {
  vtkNew<vtkPlane> plane;
  // A plane exactly through nodes would cut elements into slivers, and some of them twice; a small offset avoids that.
  const Vec3 origin = section.origin + 1.7e-4 * section.view.towards_viewer;
  plane->SetOrigin(origin.x(), origin.y(), origin.z());
  const Vec3& normal = section.view.towards_viewer;
  plane->SetNormal(normal.x(), normal.y(), normal.z());
  vtkNew<vtkCutter> cutter;
  cutter->SetCutFunction(plane);
  cutter->GenerateCutScalarsOff();
  cutter->SetInputData(data);
  cutter->Update();
  return cutter->GetOutput();
}

void lift(vtkActor* actor, const Section& section, double layer) {
  const Vec3 offset = layer * section.view.towards_viewer;
  actor->SetPosition(offset.x(), offset.y(), offset.z());
}

/// The line projected onto the plane of section.
std::vector<Vec3> projected(const std::vector<Vec3>& line, const Section& section) {
  std::vector<Vec3> flat;
  for (const Vec3& p : line) {
    flat.push_back(p - (p - section.origin).dot(section.view.towards_viewer) * section.view.towards_viewer);
  }
  return flat;
}

/// The point at which the needle crosses the plane of section, if it does.
std::optional<Vec3> crossing(const std::vector<Vec3>& line, const Section& section) {
  for (std::size_t k = 1; k < line.size(); ++k) {
    const double a = (line[k - 1] - section.origin).dot(section.view.towards_viewer);
    const double b = (line[k] - section.origin).dot(section.view.towards_viewer);
    if (a != b && a * b <= 0) return Vec3(line[k - 1] + (line[k] - line[k - 1]) * (a / (a - b)));
  }
  return std::nullopt;
}

void add_disc(vtkRenderer* stage, const Vec3& centre, double radius, const Colour& colour, const Section& section,
              double layer) {
  vtkNew<vtkRegularPolygonSource> disc;
  disc->SetNumberOfSides(48);
  disc->SetRadius(radius);
  disc->SetCenter(centre.x(), centre.y(), centre.z());
  disc->SetNormal(section.view.towards_viewer.x(), section.view.towards_viewer.y(), section.view.towards_viewer.z());
  disc->Update();
  lift(add_flat(stage, disc->GetOutput(), colour), section, layer);
}

/// Draws the needle: at its full length if it runs along the plane, as a point if it crosses the plane.
void add_needle(vtkRenderer* stage, const PictureInput& input, const Frame& frame, const Section& section) {
  if (frame.needle.size() < 2) return;
  const double diameter = input.run.info.needle_diameter_mm;
  const bool across = std::abs(input.run.info.direction.dot(section.view.towards_viewer)) > 0.7;
  if (!across) {
    lift(add_flat(stage, needle_tube(projected(frame.needle, section), diameter), kSteel), section, kNeedleLayer);
  } else if (const auto at = crossing(frame.needle, section)) {
    add_disc(stage, *at, 1.6 * diameter, kWhite, section, kNeedleLayer);
    add_disc(stage, *at, 1.0 * diameter, kSteel, section, kNeedleLayer + 1);
  }
}

// Margins for letters, scale bar and colour bar.
constexpr Area kSectionArea{0.055, 0.085, 0.945, 0.925}, kMapArea{0.055, 0.085, 0.835, 0.925};

/// The framing that shows the organs, and the needle's path if it lies in the plane.
Framing framing_of(const PictureInput& input, const Section& section, const Area& area) {
  std::vector<Vec3> places;
  const VecX at_rest = VecX::Zero(3 * input.run.mesh.node_count());
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    if (input.regions[r].background && input.regions.size() > 1) continue;
    const auto outline = cut(moved(input.surfaces[r], input.run.mesh, at_rest), section);
    for (vtkIdType n = 0; n < outline->GetNumberOfPoints(); ++n) places.emplace_back(outline->GetPoint(n));
  }
  if (std::abs(input.run.info.direction.dot(section.view.towards_viewer)) <= 0.7) {
    places.push_back(input.run.info.entry_mm - 10 * input.run.info.direction);
    if (!input.deepest.needle.empty()) places.push_back(input.deepest.needle.back());
  }
  if (places.empty()) places = input.run.mesh.nodes;
  Framing framing = frame_points(places, section.view, area, 0.12);
  framing.centre += (section.origin - framing.centre).dot(section.view.towards_viewer) * section.view.towards_viewer;
  return framing;
}

Colour fill_of(const RegionView& view) { return lighter(view.colour, view.background ? 0.72 : 0.5); }

/// Fills the regions element by element.
void fill_elements(vtkRenderer* stage, const PictureInput& input, const Frame& frame, const Section& section) {
  const auto fill = cut(deformed_grid(input.run.mesh, frame.displacement), section);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  vtkDataArray* region = fill->GetCellData()->GetArray("region");
  for (vtkIdType c = 0; c < fill->GetNumberOfCells(); ++c) {
    const auto is_it = [&](const RegionView& v) { return v.region == static_cast<int>(region->GetTuple1(c)); };
    const auto view = std::find_if(input.regions.begin(), input.regions.end(), is_it);
    const Colour colour = fill_of(*view);
    for (const double part : colour) colours->InsertNextValue(static_cast<unsigned char>(std::lround(255 * part)));
  }
  fill->GetCellData()->SetScalars(colours);
  vtkActor* filled = add_flat(stage, fill, kWhite);
  filled->GetMapper()->ScalarVisibilityOn();
  filled->GetMapper()->SetScalarModeToUseCellData();
}

/// Fills the outlines of the regions' surfaces, those that come first on top.
void fill_outlines(vtkRenderer* stage, const PictureInput& input, const Frame& frame, const Section& section) {
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    vtkNew<vtkStripper> lines;
    lines->SetInputData(cut(moved(input.surfaces[r], input.run.mesh, frame.displacement), section));
    lines->JoinContiguousSegmentsOn();
    vtkNew<vtkContourTriangulator> areas;
    areas->SetInputConnection(lines->GetOutputPort());
    areas->Update();
    lift(add_flat(stage, areas->GetOutput(), fill_of(input.regions[r])), section,
         layer_of(Drawn::fill, r, input.regions.size()));
  }
}

vtkSmartPointer<vtkRenderer> make_marked_page(const Framing& framing, const Section& section, const Area& area) {
  auto page = make_page();
  add_edge_letters(page, section.view, area);
  add_scale_bar(page, framing, area);
  return page;
}

}  // namespace

Section sagittal_section(const PictureInput& input) {
  Section section;
  section.view = {Vec3::UnitX(), Vec3::UnitZ()};
  section.origin = input.deepest.needle.empty() ? input.run.info.entry_mm : input.deepest.needle.back();
  return section;
}

Section transverse_section(const PictureInput& input) {
  Section section;
  section.view = {-Vec3::UnitZ(), -Vec3::UnitY()};
  const TetMesh& mesh = input.run.mesh;
  Vec3 moment = Vec3::Zero();
  double volume = 0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto is_target = [&](const RegionView& v) {
      return v.target && v.region == mesh.tet_region[static_cast<std::size_t>(t)];
    };
    if (std::none_of(input.regions.begin(), input.regions.end(), is_target)) continue;
    const double v = tet_volume(mesh, t);
    for (const Index n : mesh.tets[static_cast<std::size_t>(t)]) {
      moment += v / 4 * (mesh.nodes[static_cast<std::size_t>(n)] + input.deepest.displacement.segment<3>(3 * n));
    }
    volume += v;
  }
  const Vec3 tip = input.deepest.needle.empty() ? input.run.info.entry_mm : input.deepest.needle.back();
  section.origin = volume > 0 ? Vec3(moment / volume) : tip;
  return section;
}

Layers view_section(const PictureInput& input, const Frame& frame, const Section& section) {
  const Framing framing = framing_of(input, section, kSectionArea);
  const auto stage = make_stage(section.view, framing, kSectionArea);
  const TetMesh& mesh = input.run.mesh;

  if (mesh.surfaces.empty()) {
    fill_elements(stage, input, frame, section);
  } else {
    fill_outlines(stage, input, frame, section);
  }

  const VecX at_rest = VecX::Zero(3 * mesh.node_count());
  const bool is_moved = frame.displacement.lpNorm<Eigen::Infinity>() > 0.05;
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    const RegionView& view = input.regions[r];
    if (is_moved && !view.background) {
      lift(add_lines(stage, cut(moved(input.surfaces[r], mesh, at_rest), section), kPale, 1.5), section,
           layer_of(Drawn::outline_at_rest, r, input.regions.size()));
    }
    const Colour ink = lighter(view.colour, view.background ? -0.25 : -0.4);
    lift(add_lines(stage, cut(moved(input.surfaces[r], mesh, frame.displacement), section), ink,
                   view.target ? 4.0 : 2.5),
         section, layer_of(Drawn::outline, r, input.regions.size()));
  }
  add_needle(stage, input, frame, section);
  return {make_marked_page(framing, section, kSectionArea), stage};
}

Layers view_displacement(const PictureInput& input, const Frame& frame, const Section& section) {
  const Framing framing = framing_of(input, section, kMapArea);
  const auto stage = make_stage(section.view, framing, kMapArea);
  const TetMesh& mesh = input.run.mesh;
  const auto fill = cut(deformed_grid(mesh, frame.displacement), section);
  fill->GetPointData()->SetActiveScalars("displacement_mm");
  std::array<double, 2> range{0, 0};
  fill->GetPointData()->GetScalars()->GetRange(range.data());
  const double step = round_down(std::max(range[1], 0.01) / 4);
  const double most = step * std::ceil(range[1] / step - 1e-9);
  const auto colours = displacement_colours(std::max(most, step));

  vtkActor* filled = add_flat(stage, fill, kWhite);
  filled->GetMapper()->ScalarVisibilityOn();
  filled->GetMapper()->SetLookupTable(colours);
  filled->GetMapper()->UseLookupTableScalarRangeOn();
  filled->GetMapper()->InterpolateScalarsBeforeMappingOn();

  vtkNew<vtkContourFilter> isolines;
  isolines->SetInputData(fill);
  for (int k = 1; k * step < most; ++k) isolines->SetValue(k - 1, k * step);
  isolines->Update();
  vtkActor* thin = add_lines(stage, isolines->GetOutput(), kWhite, 1.0);
  thin->GetProperty()->SetOpacity(0.45);
  lift(thin, section, kInitialLayer);

  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    const auto outline = cut(moved(input.surfaces[r], mesh, frame.displacement), section);
    lift(add_lines(stage, outline, kWhite, input.regions[r].target ? 3.5 : 2.0), section, kOutlineLayer);
  }
  add_needle(stage, input, frame, section);
  const auto page = make_marked_page(framing, section, kMapArea);
  add_colour_bar(page, colours, step);
  return {page, stage};
}

}  // namespace stylet::results
