// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/stage.hpp"

#include "pictures/canvas.hpp"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkAnnotatedCubeActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkColorTransferFunction.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet::results {
namespace {

/// Factor by which the drawing is larger than the finished picture.
constexpr int kScale = Canvas::kOversampling;

/// Samples of viridis (Smith & van der Walt 2015), equally spaced.
constexpr std::array<Colour, 10> kViridis{{{0.267, 0.005, 0.329},
                                           {0.283, 0.157, 0.471},
                                           {0.244, 0.287, 0.537},
                                           {0.192, 0.408, 0.557},
                                           {0.149, 0.510, 0.557},
                                           {0.122, 0.620, 0.537},
                                           {0.208, 0.718, 0.475},
                                           {0.431, 0.808, 0.345},
                                           {0.710, 0.871, 0.169},
                                           {0.993, 0.906, 0.144}}};

/// Letter of the patient direction that is closest to a vector in LPS.
const char* letter(const Vec3& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  constexpr std::array<std::array<const char*, 2>, 3> kLetters{{{"R", "L"}, {"A", "P"}, {"I", "S"}}};
  return kLetters[static_cast<std::size_t>(axis)][direction[axis] > 0 ? 1 : 0];
}

vtkSmartPointer<vtkActor> make_actor(vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

void style_text(vtkTextProperty* style, int size, const Colour& colour) {
  style->SetFontFamilyToArial();
  style->SetFontSize(size * kScale);
  style->SetColor(colour[0], colour[1], colour[2]);
  style->SetBold(0);
  style->SetItalic(0);
  style->SetShadow(0);
}

}  // namespace

Colour lighter(const Colour& colour, double share) {
  Colour mixed{};
  for (std::size_t k = 0; k < 3; ++k) {
    mixed[k] = share >= 0 ? colour[k] + (1 - colour[k]) * share : colour[k] * (1 + share);
  }
  return mixed;
}

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double leading = value / power;
  return power * (leading >= 5 ? 5 : leading >= 2 ? 2 : 1);
}

double Area::width() const { return (right - left) * Canvas::kWidth; }
double Area::height() const { return (top - bottom) * Canvas::kHeight; }

Framing frame_points(std::span<const Vec3> points, const Viewpoint& view, const Area& area, double margin) {
  const Vec3 right = view.right();
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::max()), high = -low;
  double depth = 0;
  for (const Vec3& p : points) {
    const Eigen::Array2d at(right.dot(p), view.up.dot(p));
    low = low.min(at);
    high = high.max(at);
    depth += view.towards_viewer.dot(p) / static_cast<double>(points.size());
  }
  const Eigen::Array2d middle = (low + high) / 2, half = (high - low) / 2;
  Framing framing;
  framing.centre = right * middle[0] + view.up * middle[1] + view.towards_viewer * depth;
  framing.half_height = std::max(half[1], half[0] * area.height() / area.width()) * (1 + 2 * margin);
  return framing;
}

vtkSmartPointer<vtkRenderer> make_page() {
  auto page = vtkSmartPointer<vtkRenderer>::New();
  page->SetBackground(1, 1, 1);
  return page;
}

vtkSmartPointer<vtkRenderer> make_stage(const Viewpoint& view, const Framing& framing, const Area& area) {
  auto stage = make_page();
  stage->SetViewport(area.left, area.bottom, area.right, area.top);
  vtkCamera* camera = stage->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(framing.half_height);
  const Vec3 place = framing.centre + view.towards_viewer * 20 * framing.half_height;
  camera->SetFocalPoint(framing.centre.data());
  camera->SetPosition(place.data());
  camera->SetViewUp(view.up.data());
  camera->SetClippingRange(framing.half_height, 60 * framing.half_height);
  return stage;
}

vtkActor* add_surface(vtkRenderer* stage, vtkPolyData* data, const Colour& colour, double opacity) {
  const auto actor = make_actor(data);
  vtkProperty* look = actor->GetProperty();
  look->SetColor(colour[0], colour[1], colour[2]);
  look->SetOpacity(opacity);
  look->SetInterpolationToPhong();
  look->SetAmbient(0.34);
  look->SetDiffuse(0.68);
  look->SetSpecular(0.15);
  look->SetSpecularPower(25);
  stage->AddActor(actor);
  return actor;
}

vtkActor* add_lines(vtkRenderer* stage, vtkPolyData* data, const Colour& colour, double width) {
  const auto actor = make_actor(data);
  actor->GetProperty()->SetColor(colour[0], colour[1], colour[2]);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width * kScale));
  actor->GetProperty()->LightingOff();
  stage->AddActor(actor);
  return actor;
}

vtkActor* add_flat(vtkRenderer* stage, vtkPolyData* data, const Colour& colour) {
  const auto actor = make_actor(data);
  actor->GetProperty()->SetColor(colour[0], colour[1], colour[2]);
  actor->GetProperty()->LightingOff();
  stage->AddActor(actor);
  return actor;
}

void add_text(vtkRenderer* stage, const std::string& text, double x, double y, int size, const Colour& colour) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  style_text(actor->GetTextProperty(), size, colour);
  actor->GetTextProperty()->SetJustificationToCentered();
  actor->GetTextProperty()->SetVerticalJustificationToCentered();
  actor->SetPosition(x * kScale * Canvas::kWidth, y * kScale * Canvas::kHeight);
  stage->AddActor2D(actor);
}

void add_scale_bar(vtkRenderer* page, const Framing& framing, const Area& area) {
  const double pixels_per_mm = area.height() / (2 * framing.half_height);
  const double length_mm = round_down(0.2 * Canvas::kWidth / pixels_per_mm);
  const double right = area.right * Canvas::kWidth - (area.right < 1 ? 0 : 46), y = 34, tick = 9;
  const double left = right - length_mm * pixels_per_mm;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  const auto line = [&](double x0, double y0, double x1, double y1) {
    lines->InsertNextCell(2);
    lines->InsertCellPoint(points->InsertNextPoint(x0 * kScale, y0 * kScale, 0));
    lines->InsertCellPoint(points->InsertNextPoint(x1 * kScale, y1 * kScale, 0));
  };
  line(left, y, right, y);
  line(left, y - tick, left, y + tick);
  line(right, y - tick, right, y + tick);
  vtkNew<vtkPolyData> bar;
  bar->SetPoints(points);
  bar->SetLines(lines);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(bar);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(kInk[0], kInk[1], kInk[2]);
  actor->GetProperty()->SetLineWidth(3.0F * kScale);
  page->AddActor2D(actor);
  add_text(page, fmt::format("{:g} mm", length_mm), (left + right) / 2 / Canvas::kWidth, (y + 27) / Canvas::kHeight,
           27);
}

void add_edge_letters(vtkRenderer* page, const Viewpoint& view, const Area& area) {
  constexpr int kSize = 36;
  const double across = 32.0 / Canvas::kWidth, along = 32.0 / Canvas::kHeight;
  const double middle = (area.left + area.right) / 2, centre = (area.bottom + area.top) / 2;
  add_text(page, letter(view.up), middle, area.top + along, kSize);
  add_text(page, letter(-view.up), middle, area.bottom - along, kSize);
  add_text(page, letter(view.right()), area.right + across, centre, kSize);
  add_text(page, letter(-view.right()), area.left - across, centre, kSize);
}

vtkSmartPointer<vtkLookupTable> displacement_colours(double most) {
  vtkNew<vtkColorTransferFunction> curve;
  curve->SetColorSpaceToLab();
  for (std::size_t k = 0; k < kViridis.size(); ++k) {
    const double at = static_cast<double>(k) / (kViridis.size() - 1);
    curve->AddRGBPoint(at, kViridis[k][0], kViridis[k][1], kViridis[k][2]);
  }
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int kColours = 256;
  table->SetNumberOfTableValues(kColours);
  table->SetRange(0, most);
  for (int k = 0; k < kColours; ++k) {
    const double* c = curve->GetColor(static_cast<double>(k) / (kColours - 1));
    table->SetTableValue(k, c[0], c[1], c[2], 1);
  }
  return table;
}

void add_colour_bar(vtkRenderer* page, vtkLookupTable* colours, double step) {
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(colours);
  bar->SetNumberOfLabels(1 + static_cast<int>(std::lround(colours->GetRange()[1] / step)));
  bar->SetLabelFormat(step < 0.1 ? "%.2f" : step < 1 ? "%.1f" : "%.0f");
  bar->SetMaximumNumberOfColors(256);
  bar->UnconstrainedFontSizeOn();
  style_text(bar->GetLabelTextProperty(), 27, kInk);
  bar->SetTitle("");
  bar->SetPosition(0.9, 0.18);
  bar->SetWidth(0.085);
  bar->SetHeight(0.6);
  bar->SetBarRatio(0.32);
  page->AddActor2D(bar);
  add_text(page, "moved by", 0.935, 0.885, 27);
  add_text(page, "mm", 0.935, 0.85, 27);
}

vtkSmartPointer<vtkRenderer> orientation_cube(const Viewpoint& view) {
  vtkNew<vtkAnnotatedCubeActor> cube;
  cube->SetXPlusFaceText("L");
  cube->SetXMinusFaceText("R");
  cube->SetYPlusFaceText("P");
  cube->SetYMinusFaceText("A");
  cube->SetZPlusFaceText("S");
  cube->SetZMinusFaceText("I");
  cube->SetXFaceTextRotation(0);
  cube->SetYFaceTextRotation(0);
  cube->SetZFaceTextRotation(180);
  cube->SetFaceTextScale(0.62);
  cube->GetCubeProperty()->SetColor(0.93, 0.94, 0.95);
  cube->GetCubeProperty()->SetAmbient(0.35);
  cube->GetTextEdgesProperty()->SetLineWidth(kScale);
  cube->GetTextEdgesProperty()->SetColor(kInk[0], kInk[1], kInk[2]);
  for (vtkProperty* face :
       {cube->GetXPlusFaceProperty(), cube->GetXMinusFaceProperty(), cube->GetYPlusFaceProperty(),
        cube->GetYMinusFaceProperty(), cube->GetZPlusFaceProperty(), cube->GetZMinusFaceProperty()}) {
    face->SetColor(kInk[0], kInk[1], kInk[2]);
    face->SetInterpolationToFlat();
  }
  auto corner = make_stage(view, {Vec3::Zero(), 1.0}, {0.0, 0.0, 0.15, 0.2});
  corner->AddActor(cube);
  return corner;
}

}  // namespace stylet::results
