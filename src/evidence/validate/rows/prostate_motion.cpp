// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the motion of the demo patient's prostate with observations in patients and phantoms.
#include "../rows.hpp"
#include "published_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet::validate {

namespace {

using namespace published;

RecordedRun run_demo(Context& context, const Scenario& scenario) {
  const auto mesh = need(context.demo_mesh());
  Scenario complete = scenario;
  complete.output.frames_per_s = 0.0;
  const auto model = need(Model::compile(complete, mesh, "the demo", {}, context.progress()));
  return need(record_run(model, context.targets(), context.progress()));
}

/// Results of needles through holes on all sides of the gland, one after the other.
struct TemplateRun {
  std::vector<std::string> holes;
  std::vector<Vec3> centroid_mm;   ///< shift of the gland's centroid at each needle's deepest point
  Vec3 largest_mm = Vec3::Zero();  ///< largest displacement of any node of the gland, per axis
};

TemplateRun through_template(Context& context) {
  TemplateRun out;
  out.holes = {"c3.5", "e3.5", "c4.5", "e4.5", "D3", "d5"};
  Scenario scenario = measure::demo_scenario();
  const InsertionPlan plan = scenario.insertions.front();
  scenario.insertions.clear();
  for (const std::string& hole : out.holes) {
    scenario.insertions.push_back(plan);
    scenario.insertions.back().hole = hole;
    scenario.insertions.back().dwell_s = 0.1;
  }
  scenario.run.dt_ms = 2.0;
  const auto run = run_demo(context, scenario);
  const TetMesh& mesh = run.model->mesh();
  const std::vector<int>& target = run.model->target_regions();
  std::vector<Index> nodes;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto k = static_cast<std::size_t>(t);
    if (std::find(target.begin(), target.end(), mesh.tet_region[k]) == target.end()) continue;
    nodes.insert(nodes.end(), mesh.tets[k].begin(), mesh.tets[k].end());
  }
  for (const Frame& frame : run.events) {
    if (frame.label != "deepest") continue;
    for (const Index node : nodes)
      out.largest_mm = out.largest_mm.cwiseMax(frame.displacement.segment<3>(3 * node).cwiseAbs());
  }
  for (const TargetShift& shift : run.summary.target_shifts) out.centroid_mm.push_back(shift.centroid_mm);
  if (out.centroid_mm.size() != out.holes.size())
    throw Failed{
        failure("template", "a needle has no deepest point", "Run the same holes with stylet insert to see why")};
  return out;
}

Finding markers(Context& context) {
  const auto run = through_template(context);
  const Vec3 seen(prostate::kMarkerLateral_mm, prostate::kMarkerSagittal_mm, prostate::kMarkerAxial_mm);
  Finding finding;
  finding.value = run.largest_mm.cwiseQuotient(seen).maxCoeff();
  finding.note = fmt::format(
      "The largest displacements in the gland over six needles, one at a time, are {:.2f} mm lateral, {:.2f} mm "
      "sagittal and {:.2f} mm axial. Gold markers were displaced by up to {:g}, {:g} and {:g} mm. This is the lasting "
      "displacement relative to the gland after an implant of many needles and two weeks, not the motion under a "
      "needle. The null model, a rigid gland, gives 0, which is below the accepted range.",
      run.largest_mm.x(), run.largest_mm.y(), run.largest_mm.z(), seen.x(), seen.y(), seen.z());
  return finding;
}

}  // namespace

std::vector<RowSpec> prostate_motion_rows() {
  return {
      {"motion_markers", Group::measurements,
       "Points of the gland move as far as markers were displaced in patients, but not further",
       "gold markers before and after an implant, 18 patients, Radiat. Oncol. 7 (2012) 24", "",
       Accepted::between(0.2, 1.0), false, markers},
  };
}

}  // namespace stylet::validate
