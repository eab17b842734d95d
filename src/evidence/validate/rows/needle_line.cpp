// SPDX-License-Identifier: GPL-3.0-or-later
// A needle that is moved as a whole, compared with a bonded rigid cylinder and between meshes and spacings.
#include "../bonded_cylinder.hpp"
#include "../medium_block.hpp"
#include "../rows.hpp"
#include "stylet/coupling/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace stylet::validate {

namespace {

using Method = NeedleLine::Method;
constexpr double kSide_mm = 2.0 * MediumBlock::kHalf_mm;

/// One curve of forces for each direction in which the needle is moved.
struct Forces {
  Curve lateral;
  Curve axial;

  explicit Forces(const std::string& label, Curve::Kind kind = Curve::Kind::ours)
      : lateral{.label = label, .kind = kind}, axial(lateral) {}
  void add(double x, double lateral_N, double axial_N) {
    lateral.add(x, lateral_N);
    axial.add(x, axial_N);
  }
  [[nodiscard]] const Curve& of(bool is_lateral) const { return is_lateral ? lateral : axial; }
};

/// Curves of several methods over mesh size or spacing. They are measured once for several rows.
struct Study {
  std::vector<Forces> ours;       ///< the near field is the first
  std::vector<Forces> reference;  ///< may be empty
  double largest_factor_mb = 0.0;

  [[nodiscard]] Plot plot(const std::string& over, bool lateral) const {
    Plot plot{.x_label = over, .y_label = lateral ? "lateral force [N]" : "axial force [N]", .log_y = true};
    for (const auto* group : {&ours, &reference})
      for (const Forces& forces : *group) plot.curves.push_back(forces.of(lateral));
    return plot;
  }
};

/// A study that is measured at its first use.
class Lazy {
 public:
  explicit Lazy(Study (*measure)(Context&)) : measure_(measure) {}
  const Study& operator()(Context& context) {
    if (!study_) study_ = measure_(context);
    return *study_;
  }

 private:
  Study (*measure_)(Context&);
  std::optional<Study> study_;
};

constexpr Element kDefaultElement = Element::nodal_pressure;  ///< default element of coupling.method = "near-field"
constexpr int kFinestOfOthers = 20;  ///< finest mesh of the other methods, in cells along an edge
const std::string kNearField = "near field";
const std::string kNodeAddition = "node addition";
const std::string kEmbedded = "embedded";

/// Adds the forces on a needle line in a block to the curves: the near field for its default element, the other methods
/// for the linear tetrahedra that they need.
void measure_methods(MediumBlock& block, NeedleLine::Options options, double x, Study& study) {
  const bool near_field = block.tissue->element() == kDefaultElement;
  for (const auto& [method, curve] :
       {std::pair{Method::near_field, 0}, {Method::node_addition, 1}, {Method::embedded, 2}}) {
    if ((method == Method::near_field) != near_field) continue;
    options.method = method;
    const NeedleLine line = NeedleLine::build(block, options);
    study.ours[static_cast<std::size_t>(curve)].add(x, line.lateral(), line.axial());
  }
}

/// Measures the needle line in one block after the other. Only the near field is measured on the finest mesh, because
/// only the near field is judged.
Study over_meshes(Context& context, std::vector<int> cells, bool unbounded) {
  Study study;
  study.ours = {Forces(kNearField), Forces(kNodeAddition), Forces(kEmbedded)};
  std::sort(cells.rbegin(), cells.rend());  // sizes ascend
  for (const int n : cells) {
    report(context.progress(), fmt::format("{} nodes", (n + 1) * (n + 1) * (n + 1)), 0.0);
    for (const Element element : {kDefaultElement, Element::p1}) {
      if (element == Element::p1 && n > kFinestOfOthers) continue;
      auto block = need(MediumBlock::build({.cells = n, .element = element}));
      study.largest_factor_mb = std::max(study.largest_factor_mb, block.tissue->statistics().factor_mb);
      measure_methods(block, {.unbounded = unbounded}, kSide_mm / n, study);
    }
  }
  return study;
}

/// Ratio of the largest to the smallest value of a curve, minus 1, in percent.
double spread(const Curve& curve) {
  double most = 0.0;
  for (const double high : curve.y) {
    for (const double low : curve.y) most = worse(most, 100.0 * (high / low - 1.0));
  }
  return most;
}

std::string range(const Curve& curve) {
  const auto [low, high] = std::minmax_element(curve.y.begin(), curve.y.end());
  return fmt::format("{:.2f} … {:.2f} N {}", *low, *high, curve.label);
}

/// The ranges of forces of all methods, as text.
std::string ranges(const Study& study, bool lateral) {
  std::string text;
  for (const Forces& forces : study.ours) text += (text.empty() ? "" : ", ") + range(forces.of(lateral));
  return text;
}

const char* const kNeedle =
    "A needle of 64 mm and 18 gauge, held every 4 mm, moved by 5 mm in a cube of 100 mm (10 kPa, ν 0.45)";

Study unbounded_study(Context& context) {
  auto study = over_meshes(context, {6, 7, 9, 11, 14}, true);
  const Material material{MediumBlock::kYoung_MPa, MediumBlock::Options{}.poisson};
  const double radius = CouplingSettings{}.needle_radius_mm;
  const Medium medium{material.mu(), material.poisson};
  const auto cylinder = bonded_cylinder(NeedleLine::kLength_mm, radius, NeedleLine::kWay_mm, medium);
  const auto slender = slender_cylinder(NeedleLine::kLength_mm, radius, NeedleLine::kWay_mm, medium);
  study.reference = {Forces("bonded cylinder, boundary elements", Curve::Kind::reference),
                     Forces("slender body", Curve::Kind::reference)};
  const std::vector<double> sizes = study.ours.front().lateral.x;
  for (const double h : {sizes.front(), sizes.back()}) {
    study.reference[0].add(h, cylinder.lateral_N, cylinder.axial_N);
    study.reference[1].add(h, slender.lateral_N, slender.axial_N);
  }
  return study;
}

Finding against_cylinder(const Study& study, bool lateral) {
  const Curve& ours = study.ours.front().of(lateral);
  const double cylinder = study.reference[0].of(lateral).y.front();
  const double slender = study.reference[1].of(lateral).y.front();
  Finding finding{.value = 0.0};
  double from_slender = 0.0;
  for (const double force : ours.y) {
    finding.value = worse(finding.value, 100.0 * std::abs(force / cylinder - 1.0));
    from_slender = std::max(from_slender, 100.0 * std::abs(force / slender - 1.0));
  }
  finding.note = fmt::format(
      "{} whose outer nodes move as in an unbounded medium. The value is the largest difference on five meshes. "
      "Boundary elements give {:.2f} N, the formula for slender bodies {:.2f} N (largest difference {:.1f} %); {}. The "
      "boundary elements share only Kelvin’s solution with the coupling. The motion of the outer nodes is computed "
      "with the coupling’s own kernel, which agrees with Kelvin’s solution at this distance.",
      kNeedle, cylinder, slender, from_slender, ranges(study, lateral));
  finding.why_missed = "The kernel on the axis represents a slender cylinder and neglects its ends and R/L.";
  finding.plot = study.plot("element size [mm]", lateral);
  finding.plot.curves.pop_back();  // removes the slender body's curve, which would cover the cylinder's
  return finding;
}

Study box_study(Context& context) { return over_meshes(context, {7, 10, 14, 20, 36}, false); }

Finding over_mesh_size(const Study& study, bool lateral) {
  Finding finding;
  finding.value = spread(study.ours.front().of(lateral));
  finding.note = fmt::format(
      "{} whose outer faces are held, with 512 … 50,653 nodes; the other methods up to 9,261 nodes. The value is the "
      "ratio of the largest to the smallest force, minus 1. {}. The factor of the finest mesh takes {:.1f} GB.",
      kNeedle, ranges(study, lateral), 1e-3 * study.largest_factor_mb);
  finding.why_missed =
      "The remaining difference comes from the far field: it is represented by elements, and elements of 14 mm are "
      "stiffer than fine ones.";
  finding.plot = study.plot("element size [mm]", lateral);
  return finding;
}

Finding over_spacing(Context& context) {
  constexpr int cells = 16;
  Study study;
  study.ours = {Forces(kNearField), Forces(kNodeAddition), Forces(kEmbedded)};
  for (const Element element : {kDefaultElement, Element::p1}) {
    auto block = need(MediumBlock::build({.cells = cells, .element = element}));
    for (const int pieces : {32, 24, 16, 12, 8}) {
      const double spacing = NeedleLine::kLength_mm / pieces;
      report(context.progress(), fmt::format("every {:.1f} mm", spacing), 0.0);
      measure_methods(block, {.spacing_mm = spacing}, spacing, study);
    }
  }
  Finding finding;
  const double lateral = spread(study.ours.front().lateral);
  const double axial = spread(study.ours.front().axial);
  finding.value = worse(lateral, axial);
  finding.note = fmt::format(
      "The needle line in the held cube with 4,913 nodes and contacts 2 … 8 mm apart. The largest force exceeds the "
      "smallest by {:.2f} % laterally and {:.2f} % axially; the larger counts. Lateral: {}. Axial: {}.",
      lateral, axial, ranges(study, true), ranges(study, false));
  finding.why_missed = "The force is assumed to be uniform over pieces of the needle that are as long as the spacing.";
  finding.plot = study.plot("contact spacing [mm]", true);
  return finding;
}

}  // namespace

std::vector<RowSpec> needle_line_rows() {
  const auto unbounded = std::make_shared<Lazy>(unbounded_study);
  const auto box = std::make_shared<Lazy>(box_study);
  const std::string cylinder = "bonded rigid cylinder, boundary elements; slender body";
  return {
      {"needle_line_lateral", Group::analysis,
       "A needle that is moved sideways needs the force of a bonded rigid cylinder", cylinder, "%",
       Accepted::at_most(3.0), true, [unbounded](Context& c) { return against_cylinder((*unbounded)(c), true); }},
      {"needle_line_axial", Group::analysis,
       "A needle that is moved along its axis needs the force of a bonded rigid cylinder", cylinder, "%",
       Accepted::at_most(3.0), true, [unbounded](Context& c) { return against_cylinder((*unbounded)(c), false); }},
      {"line_mesh_size_lateral", Group::independence, "The lateral force on a needle does not depend on the mesh",
       "meshes of 512 … 50,653 nodes", "%", Accepted::at_most(3.0), false,
       [box](Context& c) { return over_mesh_size((*box)(c), true); }},
      {"line_mesh_size_axial", Group::independence, "The axial force on a needle does not depend on the mesh",
       "meshes of 512 … 50,653 nodes", "%", Accepted::at_most(6.0), false,
       [box](Context& c) { return over_mesh_size((*box)(c), false); }},
      {"line_spacing", Group::independence, "The force on a needle does not depend on the spacing of contacts",
       "contacts every 2 … 8 mm", "%", Accepted::at_most(3.0), false, over_spacing},
  };
}

}  // namespace stylet::validate
