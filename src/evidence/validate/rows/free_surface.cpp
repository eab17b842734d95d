// SPDX-License-Identifier: GPL-3.0-or-later
// The compliance of the tip at the skin and a little below it.
#include "../medium_block.hpp"
#include "../rows.hpp"
#include "../scene.hpp"
#include "../surface_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace stylet::validate {

namespace {

/// Stiffness at the hand while the tip presses on the skin, and stiffness under a flat punch [N/mm].
struct Pressed {
  double ours = 0.0;
  double punch = 0.0;
};

Pressed press_skin(const std::string& method, int cells, const std::array<double, 3>& entry) {
  Block block = Block::of_one_tissue();
  block.cells = {cells, cells, cells};
  block.entry_mm = entry;
  block.depth_mm = 5.0;
  block.scenario.coupling.method = choice<CouplingSettings::Method>(method).value();
  const auto model = need(block.compile());
  const Material& skin = model->tissue().material(0);
  constexpr double depth_mm = 0.1;
  Drive drive(model, 0.0);
  drive.go(depth_mm, 1.0);
  if (drive.event(EventKind::puncture) != nullptr)
    throw Failed{failure("flat_punch", "the skin broke at a depth below 0.1 mm", "Press less deep")};
  return Pressed{drive.last().record.force_axial_N / depth_mm,
                 2.0 * model->coupling().needle_radius_mm * skin.young_MPa / (1.0 - skin.poisson * skin.poisson)};
}

const std::string kJudged = "near-field";
constexpr std::array<std::array<double, 3>, 3> kEntries{{{3.0, 2.0, 0.0}, {-4.1, 7.3, 0.0}, {9.7, -1.2, 0.0}}};

Finding flat_punch(Context&) {
  Finding finding{.value = 0.0};
  finding.plot = {.x_label = "element size [mm]", .y_label = "stiffness [N/mm]", .log_y = true};
  double stiffness = 0.0;
  Curve punch{.label = "flat punch", .kind = Curve::Kind::reference};
  for (const std::string& method : {kJudged, std::string("embedded")}) {
    Curve curve{.label = method};
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;
    for (const int cells : {12, 8, 6, 4}) {
      double sum = 0.0;
      for (const std::array<double, 3>& entry : kEntries) {
        const auto pressed = press_skin(method, cells, entry);
        low = std::min(low, pressed.ours);
        high = std::max(high, pressed.ours);
        sum += pressed.ours;
        stiffness = pressed.punch;
        if (method == kJudged)
          finding.value = worse(finding.value, 100.0 * std::abs(pressed.ours / pressed.punch - 1.0));
      }
      curve.add(100.0 / cells, sum / static_cast<double>(kEntries.size()));
    }
    finding.note += fmt::format("{}{} {:.4f} … {:.4f} N/mm", finding.note.empty() ? "" : ", ", method, low, high);
    finding.plot.curves.push_back(std::move(curve));
  }
  finding.note = fmt::format(
      "The hand presses the tip 0.1 mm into the skin of the block, at three places on meshes of four sizes; the value "
      "is the largest difference. The punch has {:.4f} N/mm; {}. The radius of the tip’s kernel was chosen so that "
      "the tip at a surface is as stiff as a flat punch by this formula. So the row shows only that mesh, place in "
      "the mesh and the set-up of a whole insertion do not change this stiffness. The block is 100 mm wide and held "
      "on its sides, unlike a half space.",
      stiffness, finding.note);
  finding.why_missed = "A block that is held on its sides is stiffer than a half space.";
  punch.x = {finding.plot.curves.front().x.front(), finding.plot.curves.front().x.back()};
  punch.y = {stiffness, stiffness};
  finding.plot.curves.push_back(std::move(punch));
  return finding;
}

/// Kelvin’s solution plus the contribution of the free surface, by superposition [mm/N].
Mat3 point_force(const Vec3& x, const Vec3& source, const Medium& medium) {
  constexpr double point_mm = 1e-6;
  return kelvinlet(x - source, point_mm, medium) + surface_part(x, source, medium);
}

/// A block with a free face at z = −50 mm whose other faces move as in a half space.
struct HalfSpace {
  MediumBlock block;
  const Vec3 up{0.0, 0.0,
                MediumBlock::kHalf_mm};  ///< shift from the block’s coordinates to coordinates of the half space z ≥ 0

  /// Displacement of the held nodes per force at `source`.
  [[nodiscard]] std::vector<Mat3> far_field(const Vec3& source) const {
    std::vector<Mat3> field;
    for (const Index node : block.fixed)
      field.push_back(point_force(block.tissue->node_position(node) + up, source + up, block.medium));
    return field;
  }
};

/// Stiffness of the flat end of a rod in its hole at a depth below a free surface, divided by E R. By finite elements
/// with ν = 0.45 (python3 tests/reference/rod_end.py --shallow).
struct RodEnd {
  double depth_mm;
  double stiffness;
};
constexpr std::array<RodEnd, 7> kRodEnds{
    {{1.0, 2.922}, {1.5, 3.055}, {2.0, 3.150}, {3.0, 3.271}, {5.0, 3.395}, {7.0, 3.457}, {10.0, 3.508}}};

Finding mindlin(Context&) {
  const NeedleKernel needle;
  const NeedleKernel point{.radius_mm = 0.05};  // small enough to be a point force for its neighbours
  Finding finding;
  double tip_off = 0.0;
  double field_off = 0.0;
  finding.plot = {.x_label = "depth below the face [mm]", .y_label = "compliance [mm/N]"};
  Curve reference{.label = "end of a rod by finite elements", .kind = Curve::Kind::reference};
  for (const int cells : {7, 14}) {
    auto built = need(MediumBlock::build({.cells = cells, .skin = true, .element = Element::nodal_pressure}));
    HalfSpace half{std::move(built)};
    const Medium& medium = half.block.medium;
    Curve ours{.label = fmt::format("ours, elements of {:.0f} mm", 100.0 / cells)};
    const double young_MPa = half.block.tissue->material(0).young_MPa;
    for (const auto& [depth, stiffness] : kRodEnds) {
      const Vec3 source = Vec3(2.3, -1.7, depth) - half.up;
      const auto far = half.far_field(source);
      const double exact = 1.0 / (stiffness * young_MPa * needle.radius_mm);
      const double found = (half.block.tip(needle, source) + half.block.lift(source, far))(2, 2);
      tip_off = worse(tip_off, 100.0 * std::abs(found / exact - 1.0));
      ours.add(depth, found);
      if (cells == 7) reference.add(depth, exact);
      for (const Vec3& way : {Vec3(3, 0, 0), Vec3(-2, 2, 3), Vec3(0, 0, 5), Vec3(6, -4, 2)}) {
        const Vec3 seen = source + way;
        const Mat3 there = point_force(seen + half.up, source + half.up, medium);
        const Mat3 moved = half.block.tip_moves(point, source, seen) + half.block.lift(seen, far);
        field_off = worse(field_off, 100.0 * (moved - there).norm() / there.norm());
      }
    }
    finding.plot.curves.push_back(std::move(ours));
  }
  finding.plot.curves.push_back(std::move(reference));
  finding.value = worse(tip_off, field_off);
  finding.note = fmt::format(
      "At depths of 1 … 10 mm below a free face, in two meshes: the tip’s own compliance along the normal differs by "
      "at most {:.1f} % from the compliance of the flat end of a rod in its hole by finite elements. The displacement "
      "at four points 3 … 7 mm away from a point force, all nine components, differs by at most {:.1f} % from the "
      "displacement in the half space. The coupling uses Mindlin’s formula; the reference does not: it removes "
      "Kelvin’s tractions on the face with Boussinesq’s and Cerruti’s solutions, integrated over the plane. The other "
      "faces of the block move as in the reference.",
      tip_off, field_off);
  finding.why_missed =
      "At a depth of one or two radii the shape of the tip matters, which the kernel does not represent.";
  return finding;
}

}  // namespace

std::vector<RowSpec> free_surface_rows() {
  return {
      {"flat_punch", Group::analysis, "Before the puncture the skin is as stiff under the tip as under a flat punch",
       "2RE/(1−ν²) on a half space", "%", Accepted::at_most(10.0), true, flat_punch},
      {"mindlin", Group::analysis, "A force just below the skin moves the tissue as in a half space",
       "Mindlin’s problem, by superposition of Kelvin, Boussinesq and Cerruti; the end of a rod, by CalculiX", "%",
       Accepted::at_most(10.0), true, mindlin}};
}

}  // namespace stylet::validate
