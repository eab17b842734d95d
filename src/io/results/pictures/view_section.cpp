// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/shapes.hpp"
#include "pictures/views.hpp"

#include <vtkActor.h>
#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
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

/// A plane exactly through nodes would cut elements into slivers, and some of them twice; a small offset avoids that.
Vec3 origin_of_cut(const Section& section) { return section.origin + 1.7e-4 * section.view.towards_viewer; }

vtkSmartPointer<vtkPolyData> cut(vtkDataSet* data, const Section& section) {
  vtkNew<vtkPlane> plane;
  const Vec3 origin = origin_of_cut(section);
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

/// A closed line in a section: places in the picture, and numbers of its points.
struct Loop {
  std::vector<Eigen::Vector2d> places;
  std::vector<vtkIdType> points;

  [[nodiscard]] double area() const {
    double twice = 0.0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Eigen::Vector2d &a = places[k], &b = places[(k + 1) % places.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
  }
  /// Whether the loop goes round a point: a ray from it crosses the loop an odd number of times.
  [[nodiscard]] bool contains(const Eigen::Vector2d& p) const {
    bool inside = false;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Eigen::Vector2d &a = places[k], &b = places[(k + 1) % places.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    return inside;
  }
};

/// The loops that the segments of a section make.
std::vector<Loop> loops_of(vtkPolyData* joined, const Section& section) {
  std::vector<Loop> loops;
  vtkIdType count = 0;
  const vtkIdType* points = nullptr;
  vtkCellArray* lines = joined->GetLines();
  for (lines->InitTraversal(); lines->GetNextCell(count, points) != 0;) {
    Loop loop;
    loop.points.assign(points, points + count - 1);  // the last one is the first one again
    for (const vtkIdType n : loop.points) {
      const Vec3 x(joined->GetPoint(n));
      loop.places.emplace_back(x.dot(section.view.right()), x.dot(section.view.up));
    }
    if (loop.points.size() >= 3) loops.push_back(std::move(loop));
  }
  return loops;
}

/// The filled areas within closed lines; an area within another one is a hole in it.
vtkSmartPointer<vtkPolyData> areas_within(vtkPolyData* lines, const Section& section) {
  vtkNew<vtkStripper> joined;
  joined->SetInputData(lines);
  joined->JoinContiguousSegmentsOn();
  joined->SetMaximumLength(1'000'000);
  joined->Update();
  std::vector<Loop> loops = loops_of(joined->GetOutput(), section);
  vtkNew<vtkCellArray> turned;
  for (const Loop& loop : loops) {
    // A hole runs the other way round.
    const auto around = std::count_if(loops.begin(), loops.end(), [&](const Loop& other) {
      return &other != &loop && other.contains(loop.places.front());
    });
    std::vector<vtkIdType> points = loop.points;
    if ((loop.area() > 0.0) == (around % 2 == 1)) std::reverse(points.begin(), points.end());
    points.push_back(points.front());
    turned->InsertNextCell(static_cast<vtkIdType>(points.size()), points.data());
  }
  vtkNew<vtkPolyData> ordered;
  ordered->SetPoints(joined->GetOutput()->GetPoints());
  ordered->SetLines(turned);
  for (const Loop& l : loops) fprintf(stderr, "loop %zu area %g\n", l.points.size(), l.area());
  vtkNew<vtkContourTriangulator> areas;
  areas->SetInputData(ordered);
  areas->Update();
  return areas->GetOutput();
}

/// The plane around the areas within closed lines, as far as a picture may show it.
vtkSmartPointer<vtkPolyData> around(vtkPolyData* lines, const Section& section) {
  constexpr double kFar_mm = 500.0;
  const Vec3 right = kFar_mm * section.view.right(), up = kFar_mm * section.view.up;
  const Vec3 middle = origin_of_cut(section);
  const std::array<Vec3, 5> frame{middle - right - up, middle + right - up, middle + right + up, middle - right + up,
                                  middle - right - up};
  vtkNew<vtkAppendPolyData> all;
  all->AddInputData(lines);
  all->AddInputData(polyline(frame));
  all->Update();
  return areas_within(all->GetOutput(), section);
}

/// Fills the outlines of the regions' surfaces, those that come first on top.
void fill_outlines(vtkRenderer* stage, const PictureInput& input, const Frame& frame, const Section& section) {
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    const auto areas =
        areas_within(cut(moved(input.surfaces[r], input.run.mesh, frame.displacement), section), section);
    lift(add_flat(stage, areas, fill_of(input.regions[r])), section, layer_of(Drawn::fill, r, input.regions.size()));
  }
}

/// Gives a map of the elements the outline of the body's surface: what lies beyond it is covered, and gaps before it
/// get a colour.
void trim_to_body(vtkRenderer* stage, const PictureInput& input, const Frame& frame, const Section& section,
                  const Colour& gaps) {
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    if (!input.regions[r].background) continue;
    const auto outline = cut(moved(input.surfaces[r], input.run.mesh, frame.displacement), section);
    lift(add_flat(stage, areas_within(outline, section), gaps), section, -kInitialLayer);
    lift(add_flat(stage, around(outline, section), kWhite), section, 1.5 * kInitialLayer);
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

  if (!mesh.surfaces.empty()) {
    Colour none{};
    colours->GetColor(0.0, none.data());
    trim_to_body(stage, input, frame, section, none);
  }
  for (std::size_t r = 0; r < input.regions.size(); ++r) {
    if (input.regions[r].soft_layer) continue;
    const auto outline = cut(moved(input.surfaces[r], mesh, frame.displacement), section);
    lift(add_lines(stage, outline, kWhite, input.regions[r].target ? 3.5 : 2.0), section, kOutlineLayer);
  }
  add_needle(stage, input, frame, section);
  const auto page = make_marked_page(framing, section, kMapArea);
  add_colour_bar(page, colours, step);
  return {page, stage};
}

}  // namespace stylet::results
