// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/prepared_model.hpp"

#include "stylet/geom/topology.hpp"
#include "stylet/implant/needle_insertion.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/patient_mesh.hpp"

#include <chrono>
#include <functional>

namespace stylet {

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

/// The model of a scenario from the cache, or a new one, which the cache then keeps.
Result<PreparedModel> found_or_made(const Scenario& scenario, const std::function<Result<PreparedModel>()>& make,
                                    const Progress& progress, const ModelCache* cache) {
  if (cache == nullptr) return make();
  report(progress, "looking for a cached model", -1.0);
  const Result<std::string> key = model_key(scenario);
  if (!key) return make();  // its error about an unreadable file is more precise
  if (const auto kept = cache->find(*key)) {
    if (auto prepared = saved(kept->string(), {}, progress)) return prepared;
  }
  auto prepared = make();
  if (!prepared) return prepared;
  const Result<std::string> now = model_key(scenario);
  if (!now || *now != *key) return prepared;  // a file has changed in the meantime
  if (auto done = cache->keep(*prepared->model, *key, prepared->notes, progress); !done)
    prepared->not_kept = done.error().message();
  return prepared;
}

}  // namespace

std::vector<std::string> PreparedModel::warnings() const {
  std::vector<std::string> all = notes;
  all.insert(all.end(), model->warnings().begin(), model->warnings().end());
  return all;
}

Result<PreparedModel> prepare_model(const Scenario& scenario, const Progress& progress, const std::string& where) {
  if (Result<> checked = check_has_insertion(scenario, where); !checked) return checked.error();
  std::vector<std::vector<MotionSample>> motions;
  PreparedModel prepared;
  for (const InsertionPlan& plan : scenario.insertions) {
    motions.emplace_back();
    if (plan.motion.empty()) continue;
    Result<std::vector<MotionSample>> motion = read_motion_csv(plan.motion, &prepared.notes);
    if (!motion) return motion.error();
    motions.back() = std::move(*motion);
  }
  const double start = now_s();
  Result<MeshedAnatomy> patient = mesh_patient(scenario, progress);
  if (!patient) return patient.error();
  prepared.notes.insert(prepared.notes.end(), patient->report.notes.begin(), patient->report.notes.end());
  const double meshed = now_s();
  prepared.mesh_s = meshed - start;
  auto model = Model::compile(scenario, std::move(patient->mesh), where, motions, progress);
  if (!model) return model.error();
  prepared.model = std::move(*model);
  prepared.model_s = now_s() - meshed;
  return prepared;
}

Result<PreparedModel> prepare_model_file(const std::string& file, const std::vector<std::string>& settings,
                                         const Progress& progress, const ModelCache* cache) {
  if (is_hdf5_file(file) || is_meant_as_model(file)) return saved(file, settings, progress);
  const Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return scenario.error();
  return found_or_made(
      *scenario, [&] { return prepare_model(*scenario, progress, file); }, progress, cache);
}

Result<PreparedModel> prepare_needle_of_file(const std::string& file, const std::vector<std::string>& settings,
                                             const NeedleLoad& first, const Progress& progress,
                                             const ModelCache* cache) {
  const Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return scenario.error();
  const auto make = [&]() -> Result<PreparedModel> {
    PreparedModel prepared;
    const double start = now_s();
    Result<MeshedAnatomy> patient = mesh_patient(*scenario, progress);
    if (!patient) return patient.error();
    prepared.notes = patient->report.notes;
    const double meshed = now_s();
    prepared.mesh_s = meshed - start;
    Scenario with_needle = *scenario;
    {
      const Topology topology(patient->mesh);
      Result<InsertionPlan> insertion = needle_insertion(first, *scenario, Locator(patient->mesh, topology), file);
      if (!insertion) return insertion.error();
      with_needle.insertions = {*std::move(insertion)};
    }
    auto model = Model::compile(with_needle, std::move(patient->mesh), file, {}, progress);
    if (!model) return model.error();
    prepared.model = std::move(*model);
    prepared.model_s = now_s() - meshed;
    return prepared;
  };
  return found_or_made(*scenario, make, progress, cache);
}

}  // namespace stylet
