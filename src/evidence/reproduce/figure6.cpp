// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/reproduce/figure6.hpp"

#include "stylet/coupling/paper/inverse_compliance.hpp"
#include "stylet/measure/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::reproduce {

namespace {

/// Simulates the insertions step by step, as run() does, and keeps the data that the figure needs.
class Recorder {
 public:
  Recorder(const std::shared_ptr<const Model>& model, const Figure6Variant& variant, const Progress& progress)
      : model_(model), simulation_(model), progress_(progress), dt_s_(1e-3 * model->scenario().run.dt_ms) {
    run_.variant = variant;
    for (const PlannedInsertion& insertion : model->insertions()) total_s_ += insertion.motion.duration_s();
  }

  Result<Figure6Run> all() {
    for (std::size_t i = 0; i < model_->insertions().size(); ++i) {
      one(i);
      if (simulation_.last_step().tip_state != TipState::air) {
        return failure("figure 6, " + run_.variant.label, "the needle is still in the tissue at the end",
                       "Run the same scenario with stylet insert to find the cause");
      }
    }
    const auto* full = dynamic_cast<const paper::InverseCompliance*>(&simulation_.insertion().compliance());
    run_.compliance_mb = full != nullptr ? full->inverse().megabytes() : simulation_.insertion().store().megabytes();
    return std::move(run_);
  }

 private:
  void one(std::size_t number) {
    const PlannedInsertion& insertion = model_->insertions()[number];
    const auto steps = static_cast<long>(std::ceil(insertion.motion.duration_s() / dt_s_ - 1e-9));
    simulation_.place(insertion);
    for (long k = 1; k <= steps; ++k) {
      const Pose base = drifted(insertion, number, insertion.motion.at(static_cast<double>(k) * dt_s_));
      simulation_.prepare();
      const double seconds = measure::cpu_seconds([&] { simulation_.step(base, dt_s_); });
      Step record = simulation_.last_step();
      record.step_us = 1e6 * seconds;
      const std::size_t iteration = run_.steps.size();
      for (const Event& event : simulation_.new_events()) run_.events.push_back({iteration, number, event});
      const auto remeshing = simulation_.insertion().compliance().remeshing();
      const auto made = std::min(static_cast<std::size_t>(simulation_.last_step().remeshings), remeshing.size());
      for (const RemeshEvent& change : remeshing.last(made)) run_.remeshes.push_back({iteration, number, change});
      run_.remeshings.push_back(static_cast<int>(made));
      run_.insertion.push_back(number);
      run_.steps.push_back(record);
      if (simulation_.last_step().flags & Step::not_converged) ++run_.not_converged;
      if (k % 64 == 0) report(progress_, "figure 6, " + run_.variant.label, record.time_s / total_s_);
    }
  }

  /// Adds the drift of the hand: sideways as it goes in, and back as it comes out.
  [[nodiscard]] Pose drifted(const PlannedInsertion& insertion, std::size_t number, Pose base) const {
    const Vec3 tip = base.origin + model_->scenario().needle.length_mm * (base.rotation * Vec3::UnitZ());
    const double depth = (tip - insertion.entry).dot(insertion.direction);
    base.origin += std::clamp(depth / insertion.depth_mm, 0.0, 1.0) * figure6_drift_mm(number);
    return base;
  }

  std::shared_ptr<const Model> model_;
  Simulation simulation_;
  const Progress& progress_;
  double dt_s_;
  double total_s_ = 0.0;
  Figure6Run run_;
};

/// Step times [s] of the iterations with, or without, a change of the mesh.
std::vector<double> chosen(const Figure6Run& run, bool with_remeshing) {
  std::vector<double> seconds;
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    if ((run.remeshings[i] > 0) == with_remeshing) seconds.push_back(1e-6 * run.steps[i].step_us);
  }
  return seconds;
}

}  // namespace

double Figure6Run::total_s() const {
  double sum = 0.0;
  for (const Step& step : steps) sum += 1e-6 * step.step_us;
  return sum;
}

double Figure6Run::worst_s(bool with_remeshing) const {
  const auto seconds = chosen(*this, with_remeshing);
  return seconds.empty() ? 0.0 : *std::max_element(seconds.begin(), seconds.end());
}

double Figure6Run::median_s(bool with_remeshing) const { return measure::median(chosen(*this, with_remeshing)); }

const Figure6Run& Figure6::run(const std::string& id) const {
  const auto found =
      std::find_if(runs.begin(), runs.end(), [&](const Figure6Run& run) { return run.variant.id == id; });
  return found != runs.end() ? *found : runs.back();
}

std::vector<Figure6Variant> figure6_variants() {
  return {{"bcs_repositioning", "switches, node repositioning", "node-repositioning", "interior", "bcs"},
          {"woodbury_addition", "Woodbury, node addition", "node-addition", "paper", "woodbury"},
          {"default", "this program’s default for node addition", "node-addition", "interior", "condensed"}};
}

Scenario figure6_scenario(bool quick) {
  Scenario scenario;
  scenario.name = "Figure 6";
  scenario.patient.source = "phantom";
  scenario.mesh.preset = MeshPreset::paper;
  scenario.tissue_model.preset = TissuePreset::linear;
  scenario.fixed.regions = {"band"};  // the pubic side, as in the paper
  scenario.fixed.outer = OuterSupport::none;
  scenario.run.dt_ms = quick ? 2.0 : 1.0;

  InsertionPlan straight;
  straight.hole = "e3.5";
  straight.speed_mm_per_s = straight.retract_speed_mm_per_s = 30.0;
  scenario.insertions.push_back(straight);
  if (quick) {
    scenario.insertions.back().depth_mm = 40.0;
    return scenario;
  }
  InsertionPlan oblique;
  oblique.entry_mm = {-16.0, 3.0, -70.0};
  oblique.target_mm = {-5.0, -3.0, 10.0};
  oblique.speed_mm_per_s = oblique.retract_speed_mm_per_s = 30.0;
  scenario.insertions.push_back(oblique);
  return scenario;
}

Vec3 figure6_drift_mm(std::size_t insertion) { return insertion % 2 == 0 ? Vec3(3.0, 1.5, 0.0) : Vec3(-2.0, 3.0, 0.0); }

Result<std::shared_ptr<const Model>> figure6_model(const Scenario& scenario, const Figure6Variant& variant,
                                                   const TetMesh& mesh, const Progress& progress) {
  Scenario own = scenario;
  own.coupling.method = choice<CouplingSettings::Method>(variant.method).value();
  own.coupling.rule = choice<CouplingSettings::Rule>(variant.rule).value();
  own.coupling.engine = choice<CouplingSettings::Engine>(variant.engine).value();
  return Model::compile(own, mesh, "figure 6, " + variant.label, {}, progress);
}

Result<Figure6Run> run_insertions(const std::shared_ptr<const Model>& model, const Figure6Variant& variant, int times,
                                  const Progress& progress) {
  std::vector<Figure6Run> runs;
  for (int i = 0; i < std::max(1, times); ++i) {
    auto run = Recorder(model, variant, progress).all();
    if (!run) return run;
    runs.push_back(std::move(*run));
  }
  Figure6Run& first = runs.front();
  for (std::size_t k = 0; k < first.steps.size(); ++k) {
    std::vector<double> step_us;
    for (const Figure6Run& run : runs) step_us.push_back(run.steps[k].step_us);
    first.steps[k].step_us = measure::median(std::move(step_us));
  }
  return std::move(first);
}

}  // namespace stylet::reproduce
