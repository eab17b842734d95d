// SPDX-License-Identifier: GPL-3.0-or-later
#include "patients.hpp"

#include "need.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/mesher/mesher.hpp"

#include <algorithm>

namespace stylet::validate {

bool Patients::is_there(const Context& context, PatientCase patient) {
  return patient == PatientCase::demo || context.data(kMask).has_value();
}

TetMesh Patients::mesh(Context& context, PatientCase patient) {
  if (patient == PatientCase::demo) return need(context.demo_mesh());
  if (!mask_) {
    const auto image = need(read_label_image(*context.data(kMask)));
    const Scenario standard = measure::demo_scenario();
    MeshOptions options;
    options.nodes = standard.mesh.nodes;
    options.layers = standard.anatomy;
    mask_ = need(mesh_labels(image, options, context.progress())).mesh;
  }
  return *mask_;
}

std::shared_ptr<const RecordedRun> Patients::run(Context& context, PatientCase patient, const PatientRun& how) {
  auto& kept = runs_[{patient, how}];
  if (kept) return kept;
  Scenario scenario = measure::demo_scenario();
  scenario.output.frames_per_s = 0.0;
  scenario.needle.bevel_deg = how.bevel_deg;
  if (!how.creeps) scenario.tissue_model.creep = 1.0;
  InsertionPlan& plan = scenario.insertions.front();
  if (patient == PatientCase::mask) {
    scenario.patient.source = kMask;
    plan.hole = "e4";
  }
  if (!how.hole.empty()) plan.hole = how.hole;
  plan.speed_mm_per_s = how.speed_mm_per_s;
  plan.dwell_s = 0.0;
  plan.retract = false;
  if (how.depth_mm) plan.depth_mm = *how.depth_mm;
  constexpr double step_mm = 0.04;
  scenario.run.dt_ms = std::clamp(1e3 * step_mm / how.speed_mm_per_s, 0.25, 8.0);
  const auto model = need(Model::compile(scenario, mesh(context, patient), "the patient", {}, context.progress()));
  kept = std::make_shared<const RecordedRun>(need(record_run(model, context.targets(), context.progress())));
  return kept;
}

double seat_N_per_mm(const Model& model) {
  const TetMesh& mesh = model.mesh();
  const std::vector<int>& target = model.target_regions();
  MatX force = MatX::Zero(3 * model.tissue().displacement_nodes(), 1);
  double volume = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto k = static_cast<std::size_t>(t);
    if (std::find(target.begin(), target.end(), mesh.tet_region[k]) == target.end()) continue;
    const double share = 0.25 * tet_volume(mesh, t);
    volume += 4.0 * share;
    for (const Index node : mesh.tets[k]) force(3 * Eigen::Index{node} + 2, 0) += share;
  }
  force /= volume;  // 1 N in total; the same vector gives the weights of the mean
  return 1.0 / force.col(0).dot(model.tissue().solve(force).col(0));
}

}  // namespace stylet::validate
