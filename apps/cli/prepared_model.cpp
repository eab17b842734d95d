// SPDX-License-Identifier: GPL-3.0-or-later
#include "prepared_model.hpp"

#include "patient_model.hpp"

#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"

#include <chrono>

namespace stylet::cli {

namespace {

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Result<PreparedModel> saved(const std::string& file, const std::vector<std::string>& settings,
                            const Progress& progress) {
  PreparedModel prepared;
  const double start = now_s();
  Result<ModelFile> content = read_model_file(file, progress);
  if (!content) return content.error();
  prepared.notes = content->notes;
  auto model = compile_model(std::move(*content), file, progress, settings);
  if (!model) return model.error();
  prepared.model = std::move(*model);
  prepared.model_s = now_s() - start;
  return prepared;
}

}  // namespace

Result<PreparedModel> prepared_model(const std::string& file, const std::vector<std::string>& settings,
                                     const Progress& progress) {
  if (is_hdf5_file(file)) return saved(file, settings, progress);
  const Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return scenario.error();
  std::vector<std::vector<MotionSample>> motions;
  for (const InsertionPlan& plan : scenario->insertions) {
    motions.emplace_back();
    if (plan.motion.empty()) continue;
    Result<std::vector<MotionSample>> motion = read_motion_csv(plan.motion);
    if (!motion) return motion.error();
    motions.back() = std::move(*motion);
  }
  PreparedModel prepared;
  const double start = now_s();
  Result<MeshedAnatomy> patient = patient_model(*scenario, file, progress);
  if (!patient) return patient.error();
  prepared.notes = patient->report.notes;
  const double meshed = now_s();
  prepared.mesh_s = meshed - start;
  auto model = Model::compile(*scenario, std::move(patient->mesh), file, motions, progress);
  if (!model) return model.error();
  prepared.model = std::move(*model);
  prepared.model_s = now_s() - meshed;
  return prepared;
}

}  // namespace stylet::cli
