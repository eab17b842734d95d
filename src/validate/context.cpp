// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/validate/context.hpp"

#include "stylet/mesher/mesher.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

namespace stylet::validate {
namespace fs = std::filesystem;

namespace {

/// Stores every step and the labelled frames of a run.
class Keeper final : public RunObserver {
 public:
  explicit Keeper(RecordedRun& run) : run_(run) {}
  Result<> on_step(const Step& step) override {
    run_.steps.push_back(step);
    return Ok{};
  }
  Result<> on_frame(const Frame& frame) override {
    if (!frame.label.empty()) run_.events.push_back(frame);
    return Ok{};
  }

 private:
  RecordedRun& run_;
};

}  // namespace

const Event* RecordedRun::event(EventKind kind, const std::string& region) const {
  for (const Event& event : summary.events) {
    if (event.kind == kind && (region.empty() || event.region == region)) return &event;
  }
  return nullptr;
}

Result<RecordedRun> record_run(const std::shared_ptr<const Model>& model, const Progress& progress) {
  RecordedRun recorded;
  recorded.model = model;
  Keeper keeper(recorded);
  auto summary = run(model, keeper, progress);
  if (!summary) return summary.error();
  recorded.summary = std::move(*summary);
  return recorded;
}

Scenario demo_scenario() {
  Scenario scenario;
  scenario.name = "Demo: one needle into the left half of the prostate";
  scenario.patient.source = "phantom";
  scenario.fixed.outer = OuterSupport::sides;
  scenario.mesh.nodes = 3000;
  scenario.needle.lumen_diameter_mm = 1.0;
  scenario.needle.bevel_deg = 20.0;
  scenario.grid.guide = true;
  InsertionPlan plan;
  plan.hole = "e3.5";
  scenario.insertions.push_back(plan);
  return scenario;
}

std::optional<fs::path> Context::data(const std::string& file) const {
  const fs::path path = data_ / file;
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return std::nullopt;
  return path;
}

std::string Context::no_data(const std::string& file) const {
  return fmt::format(
      "{} does not exist. Name the folder of the shared data with --data or the environment variable "
      "STYLET_SHARED_DATA.",
      (data_ / file).string());
}

Result<MeshedAnatomy> mesh_demo(Index nodes, const Progress& progress) {
  MeshOptions options;
  options.nodes = nodes;
  options.cull_tolerance_mm = demo_scenario().mesh.cull_mm;
  options.layers = demo_scenario().anatomy;
  return mesh_contours(demo_patient(), options, progress);
}

Result<TetMesh> Context::demo_mesh() {
  if (!demo_mesh_) {
    auto meshed = mesh_demo(demo_scenario().mesh.nodes, progress_);
    if (!meshed) return meshed.error();
    demo_mesh_ = std::move(meshed->mesh);
  }
  return *demo_mesh_;
}

Result<std::shared_ptr<const RecordedRun>> Context::demo_run() {
  if (!demo_run_) {
    Scenario scenario = demo_scenario();
    scenario.output.frames_per_s = 0.0;
    const auto mesh = demo_mesh();
    if (!mesh) return mesh.error();
    const auto model = Model::compile(scenario, *mesh, "the demo", {}, progress_);
    if (!model) return model.error();
    auto recorded = record_run(*model, progress_);
    if (!recorded) return recorded.error();
    demo_run_ = std::make_shared<const RecordedRun>(std::move(*recorded));
  }
  return demo_run_;
}

Result<std::vector<CouplingRow>> Context::demo_on_meshes() {
  if (demo_on_meshes_.empty()) {
    auto rows = bench_coupling({.largest = 10000, .mesh_only = true}, progress_);
    if (!rows) return rows.error();
    demo_on_meshes_ = std::move(*rows);
  }
  return demo_on_meshes_;
}

}  // namespace stylet::validate
