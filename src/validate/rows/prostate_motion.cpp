// SPDX-License-Identifier: GPL-3.0-or-later
// How the demo patient's prostate moves, against what was seen in patients and phantoms.
#include "../rows.hpp"
#include "published_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet::validate {

namespace {

using namespace published;

Result<RecordedRun> run_demo(Context& context, const Scenario& scenario) {
  const auto mesh = context.demo_mesh();
  if (!mesh) return mesh.error();
  Scenario complete = scenario;
  complete.output.frames_per_s = 0.0;
  const auto model = Model::compile(complete, *mesh, "the demo", {}, context.progress());
  if (!model) return model.error();
  return record_run(*model, context.progress());
}

/// Shift of the gland along the needle at the deepest point [mm], by the speed of insertion.
Result<Finding> slow_against_fast(Context& context) {
  Finding finding;
  Curve curve{.label = "shift of the gland", .x = {}, .y = {}};
  for (const double speed : {1.0, 5.0, 20.0, 100.0, 400.0}) {
    Scenario scenario = demo_scenario();
    InsertionPlan& plan = scenario.insertions.front();
    plan.speed_mm_per_s = speed;
    plan.dwell_s = 0.0;
    plan.retract = false;
    scenario.run.dt_ms = std::clamp(0.1 / speed * 1e3, 0.25, 10.0);
    const auto run = run_demo(context, scenario);
    if (!run) return run.error();
    curve.x.push_back(speed);
    curve.y.push_back(run->summary.target_shift_centroid_mm.norm());
  }
  finding.value = curve.y.front() / curve.y.back();
  finding.note = fmt::format(
      "{:.2f} mm at {:g} mm/s, {:.2f} mm at {:g} mm/s. In a phantom up to {:g} mm when pushed slowly, {:g} mm when "
      "driven fast.",
      curve.y.front(), curve.x.front(), curve.y.back(), curve.x.back(), prostate::kSlowShift_mm,
      prostate::kFastShift_mm);
  finding.why_missed =
      "The tissue is quasi-static and friction grows with speed, so a faster needle drags more. What holds a real "
      "gland back "
      "in a fast insertion, its inertia, the tissue’s viscosity and a cutting force that falls with speed, is not in "
      "the "
      "default model.";
  finding.plot = {.x_label = "speed [mm/s]", .y_label = "shift of the gland [mm]", .log_x = true, .curves = {curve}};
  return finding;
}

/// Needles through holes on all sides of the gland, one after the other.
struct TemplateRun {
  std::vector<std::string> holes;
  std::vector<Vec3> centroid_mm;   ///< shift of the gland's centroid at each needle's deepest point
  Vec3 largest_mm = Vec3::Zero();  ///< of any node of the gland, by axis
};

Result<TemplateRun> through_template(Context& context) {
  TemplateRun out;
  out.holes = {"c3.5", "e3.5", "c4.5", "e4.5", "D3", "d5"};
  Scenario scenario = demo_scenario();
  const InsertionPlan plan = scenario.insertions.front();
  scenario.insertions.clear();
  for (const std::string& hole : out.holes) {
    scenario.insertions.push_back(plan);
    scenario.insertions.back().hole = hole;
    scenario.insertions.back().dwell_s = 0.1;
  }
  scenario.run.dt_ms = 2.0;
  const auto run = run_demo(context, scenario);
  if (!run) return run.error();
  const TetMesh& mesh = run->model->mesh();
  const std::vector<int>& target = run->model->target_regions();
  std::vector<Index> nodes;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto k = static_cast<std::size_t>(t);
    if (std::find(target.begin(), target.end(), mesh.tet_region[k]) == target.end()) continue;
    nodes.insert(nodes.end(), mesh.tets[k].begin(), mesh.tets[k].end());
  }
  for (const Frame& frame : run->events) {
    if (frame.label != "deepest") continue;
    for (const Index node : nodes)
      out.largest_mm = out.largest_mm.cwiseMax(frame.displacement.segment<3>(3 * node).cwiseAbs());
  }
  for (const TargetShift& shift : run->summary.target_shifts) out.centroid_mm.push_back(shift.centroid_mm);
  if (out.centroid_mm.size() != out.holes.size())
    return failure("template", "a needle has no deepest point", "Run the same holes with stylet insert to see why");
  return out;
}

Result<Finding> motion_by_axis(Context& context) {
  const auto run = through_template(context);
  if (!run) return run.error();
  Vec3 mean = Vec3::Zero();
  std::array<Curve, 3> curves;
  const std::array<const char*, 3> names{"lateral", "sagittal", "axial"};
  for (std::size_t k = 0; k < run->centroid_mm.size(); ++k) {
    mean += run->centroid_mm[k].cwiseAbs() / static_cast<double>(run->centroid_mm.size());
    for (int axis = 0; axis < 3; ++axis) {
      Curve& curve = curves[static_cast<std::size_t>(axis)];
      curve.label = names[static_cast<std::size_t>(axis)];
      curve.x.push_back(static_cast<double>(k + 1));
      curve.y.push_back(std::abs(run->centroid_mm[k][axis]));
    }
  }
  Finding finding;
  finding.value = mean.z() / std::max(mean.x(), mean.y());
  finding.note = fmt::format(
      "Mean shift of the gland’s centroid over holes {}: lateral {:.2f}, sagittal {:.2f}, axial {:.2f} mm. Seeds were "
      "misplaced by {:g}, {:g} and {:g} cm on average, a ratio of {:.1f}; seeds have other errors beside the gland’s "
      "motion.",
      fmt::join(run->holes, ", "), mean.x(), mean.y(), mean.z(), prostate::kSeedX_cm, prostate::kSeedY_cm,
      prostate::kSeedZ_cm, prostate::kSeedZ_cm / prostate::kSeedY_cm);
  finding.plot = {
      .x_label = "needle", .y_label = "shift of the centroid [mm]", .curves = {curves[0], curves[1], curves[2]}};
  return finding;
}

Result<Finding> markers(Context& context) {
  const auto run = through_template(context);
  if (!run) return run.error();
  const Vec3 seen(prostate::kMarkerLateral_mm, prostate::kMarkerSagittal_mm, prostate::kMarkerAxial_mm);
  Finding finding;
  finding.value = run->largest_mm.cwiseQuotient(seen).maxCoeff();
  finding.note = fmt::format(
      "Largest displacement in the gland over six needles, one at a time: lateral {:.2f}, sagittal {:.2f}, axial "
      "{:.2f} mm; "
      "gold markers moved by up to {:g}, {:g} and {:g} mm. An upper bound only: a gland that hardly moves passes too.",
      run->largest_mm.x(), run->largest_mm.y(), run->largest_mm.z(), seen.x(), seen.y(), seen.z());
  return finding;
}

}  // namespace

std::vector<RowSpec> prostate_motion_rows() {
  return {
      {"motion_speed", Group::measurements, "The gland moves further under a slow needle than under a fast one",
       "McLaughlin et al., AAPM 2022: 2 cm slow, 1 mm fast, in a phantom", "", Accepted::at_least(1.0), false,
       slow_against_fast},
      {"motion_axis", Group::measurements, "The gland moves along the needle more than across it",
       "seed misplacement by axis, 357 needles in 15 patients", "", Accepted::at_least(1.0), false, motion_by_axis},
      {"motion_markers", Group::measurements, "No point of the gland moves further than markers did in patients",
       "gold markers, 18 patients, Radiat. Oncol. 7 (2012) 24", "", Accepted::at_most(1.0), false, markers},
  };
}

}  // namespace stylet::validate
