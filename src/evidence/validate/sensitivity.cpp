// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/sensitivity.hpp"

#include "fem/blas_threads.hpp"
#include "sim/needle_choice.hpp"
#include "stylet/core/parallel.hpp"
#include "stylet/evidence/validate/context.hpp"
#include "stylet/mesher/mesher.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <thread>

namespace stylet::validate {

namespace {

constexpr double kLargestPoisson = 0.49;

struct Parameter {
  std::string key;
  std::string meaning;
};

/// The keys of a region's parameters and their meaning in words.
std::vector<Parameter> tissue_parameters(const std::string& region, bool quick) {
  std::string name = region;
  std::replace(name.begin(), name.end(), '_', ' ');
  const std::string path = "tissue." + region + ".";
  std::vector<Parameter> parameters{{path + "young_kPa", name + ": Young’s modulus"}};
  if (quick) return parameters;
  for (const auto& [key, meaning] : {std::pair{"poisson", "Poisson’s ratio"},
                                     {"puncture_N", "force that punctures its surface"},
                                     {"cutting_N", "cutting force"},
                                     {"friction_static_N_per_m", "static friction"},
                                     {"friction_coulomb_N_per_m", "sliding (Coulomb) friction"},
                                     {"friction_viscous_Ns_per_m2", "viscous friction"}})
    parameters.push_back({path + key, name + ": " + meaning});
  return parameters;
}

std::string unit_of(const std::string& key) {
  // The documented keys have placeholders: "tissue.<region>.young_kPa" for "tissue.prostate.young_kPa", "insertion[].x"
  // for "insertion[0].x". So only the first letters and the last word are compared.
  const std::string last = key.substr(key.rfind('.'));
  for (const ScenarioKey& known : scenario_keys()) {
    const bool same_table = known.path.substr(0, 4) == key.substr(0, 4);
    if (same_table && known.path.size() > last.size() && known.path.ends_with(last)) return known.unit;
  }
  return {};
}

Outputs outputs_of(const Summary& summary) {
  return {summary.peak_axial_N, summary.target_shift_centroid_mm.norm(), summary.tip_deflection_mm};
}

class Study {
 public:
  Study(bool quick, const Progress& progress) : quick_(quick), progress_(progress) {}

  Result<Sensitivity> all() {
    const auto started = std::chrono::steady_clock::now();
    const detail::OneBlasThread one_thread;  // the runs share the cores
    out_.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    if (auto done = base(); !done) return done.error();
    for (const Parameter& p : parameters()) move(p);
    choose("fixed.outer", "support of the body: only the pubic arch", "none");
    choose("fixed.outer", "support of the body: all outer faces, including the perineum", "all");
    if (!quick_) choose("coupling.method", "coupling: interpolated contacts", "embedded");
    carry_out();
    out_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return std::move(out_);
  }

 private:
  /// Runs the demo with its base values: gives the mesh, the outputs and the regions that the needle meets.
  Result<> base() {
    scenario_ = measure::demo_scenario();
    scenario_.output.frames_per_s = 0.0;
    scenario_.needle.lumen_diameter_mm.reset();  // the lumen follows the diameter
    if (quick_) {
      scenario_.mesh.nodes = 600;
      scenario_.run.dt_ms = 4.0;
      scenario_.insertions.front().depth_mm = 70.0;
      scenario_.insertions.front().retract = false;
    }
    MeshOptions options;
    options.nodes = scenario_.mesh.nodes;
    options.cull_tolerance_mm = scenario_.mesh.cull_mm;
    options.layers = scenario_.anatomy;
    auto meshed = mesh_contours(demo_patient(), options, progress_);
    if (!meshed) return meshed.error();
    mesh_ = std::move(meshed->mesh);
    const auto summary = summary_of(scenario_);
    if (!summary) return summary.error();
    out_.base = outputs_of(*summary);
    out_.scenario = fmt::format("{}, {} nodes", scenario_.name, mesh_.node_count());
    for (const Event& event : summary->events) {
      if (!event.region.empty() && std::find(regions_.begin(), regions_.end(), event.region) == regions_.end())
        regions_.push_back(event.region);
    }
    for (const std::string& region : regions_) scenario_.tissue.try_emplace(region, tissue_of(scenario_, region));
    return Ok{};
  }

  [[nodiscard]] Result<Summary> summary_of(const Scenario& scenario) {
    const auto model = Model::compile(scenario, mesh_, "sensitivity");
    if (!model) return model.error();
    auto recorded = record_run(*model, targets_);
    if (!recorded) return recorded.error();
    return std::move(recorded->summary);
  }

  [[nodiscard]] std::vector<Parameter> parameters() const {
    std::vector<Parameter> all;
    for (const std::string& region : regions_) {
      const auto more = tissue_parameters(region, quick_);
      all.insert(all.end(), more.begin(), more.end());
    }
    all.push_back({"needle.bending_stiffness_Nmm2", "needle: bending stiffness"});
    if (quick_) return all;
    all.push_back({"needle.diameter_mm", "needle: diameter, lumen in proportion"});
    all.push_back({"needle.length_mm", "needle: length"});
    all.push_back({"insertion[0].speed_mm_per_s", "speed of insertion"});
    all.push_back({"coupling.tip_viscosity_Ns_per_m", "viscosity of cutting"});
    return all;
  }

  void add_job(const std::string& key, const ScenarioValue& value, std::size_t influence, Outputs Influence::*outputs) {
    Scenario changed = scenario_;
    Influence& i = out_.influences[influence];
    if (auto set = set_scenario_key(changed, key, value, "sensitivity"); !set) {
      i.note = set.error().message();
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      i.*outputs = {none, none, none};
      return;
    }
    jobs_.push_back({std::move(changed), influence, outputs});
  }

  /// Adds two runs with a parameter decreased and increased.
  void move(const Parameter& parameter) {
    auto value = scenario_value(scenario_, parameter.key);
    if (parameter.key ==
        "needle.bending_stiffness_Nmm2") {  // computed from tube and stylet if the scenario gives no value
      if (const auto section = needle_section(scenario_.needle); section)
        value = ScenarioValue{.number = section->bending_stiffness_Nmm2};
    }
    if (!value || value->number == 0.0) return;  // a relative change of 0 changes nothing
    Influence influence;
    influence.key = parameter.key;
    influence.meaning = parameter.meaning;
    influence.unit = unit_of(parameter.key);
    influence.base = fmt::format("{:g}", value->number);
    ScenarioValue low = *value;
    ScenarioValue high = *value;
    low.number *= 1.0 - out_.change;
    high.number *= 1.0 + out_.change;
    if (parameter.key.ends_with(".poisson") && high.number > kLargestPoisson) {
      high.number = kLargestPoisson;
      influence.note = fmt::format("limited to {:g}", kLargestPoisson);
    }
    influence.low = fmt::format("{:g}", low.number);
    influence.high = fmt::format("{:g}", high.number);
    out_.influences.push_back(std::move(influence));
    add_job(parameter.key, low, out_.influences.size() - 1, &Influence::at_low);
    add_job(parameter.key, high, out_.influences.size() - 1, &Influence::at_high);
  }

  /// Adds a run in which another word is chosen.
  void choose(const std::string& key, const std::string& meaning, const std::string& word) {
    const auto value = scenario_value(scenario_, key);
    if (!value || value->text == word) return;
    Influence influence;
    influence.key = key;
    influence.meaning = meaning;
    influence.base = value->text;
    influence.low = word;
    out_.influences.push_back(std::move(influence));
    ScenarioValue other = *value;
    other.text = word;
    add_job(key, other, out_.influences.size() - 1, &Influence::at_low);
  }

  /// Carries all runs out, several at a time.
  void carry_out() {
    std::mutex mutex;
    const auto work = [&](std::size_t mine) {
      const Job& job = jobs_[mine];
      const auto summary = summary_of(job.scenario);
      const std::lock_guard lock(mutex);
      Influence& influence = out_.influences[job.influence];
      if (summary) {
        influence.*job.outputs = outputs_of(*summary);
      } else {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        influence.*job.outputs = {none, none, none};
        influence.note = summary.error().message();
      }
    };
    for_each_in_parallel(jobs_.size(), work, progress_, "sensitivity");
  }

  /// A run of the study: its scenario and the place of its outputs.
  struct Job {
    Scenario scenario;
    std::size_t influence = 0;
    Outputs Influence::*outputs = nullptr;
  };

  bool quick_;
  const Progress& progress_;
  Scenario scenario_;
  TetMesh mesh_;
  KnownTargets targets_;
  std::vector<std::string> regions_;
  std::vector<Job> jobs_;
  Sensitivity out_;
};

}  // namespace

Result<Sensitivity> measure_sensitivity(bool quick, const Progress& progress) { return Study(quick, progress).all(); }

}  // namespace stylet::validate
