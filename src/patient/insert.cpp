// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/insert.hpp"

#include "stylet/io/results_writer.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/run.hpp"

namespace stylet {

namespace {

/// Writes the steps and frames of a run to the result files, and keeps the steps.
class Recorder final : public RunObserver {
 public:
  Recorder(ResultsWriter& writer, std::vector<Step>& steps) : writer_(writer), steps_(steps) {}
  Result<> on_step(const Step& step) override {
    steps_.push_back(step);
    return writer_.add_step(step);
  }
  Result<> on_frame(const Frame& frame) override { return writer_.add_frame(frame); }

 private:
  ResultsWriter& writer_;
  std::vector<Step>& steps_;
};

}  // namespace

Result<InsertResult> insert(const PreparedModel& prepared, const std::filesystem::path& folder,
                            const InsertSettings& settings, const Progress& progress) {
  const std::shared_ptr<const Model>& model = prepared.model;
  const Scenario& scenario = model->scenario();
  const PlanOfHole plan_of = [&scenario](const std::string& hole) {
    return plan_through(scenario.insertions.front(), hole);
  };
  InsertResult result;
  if (settings.map) {
    if (Result<> possible = check_mappable(scenario, settings.where); !possible) return possible.error();
    auto ways = map_ways(*model, plan_of, settings.where);
    if (!ways) return ways.error();
    result.map = std::move(*ways);
  }
  if (scenario.probe.kind != ProbeKind::none) {
    auto probe = report_probe(*model, settings.where, progress);
    if (!probe) return probe.error();
    result.probe = std::move(*probe);
  }
  if (settings.begin) settings.begin();
  RunInfo info = model->info();
  info.scenario_text = to_toml(scenario);
  info.warnings = prepared.warnings();
  const Tissue& tissue = model->tissue();
  Result<std::unique_ptr<ResultsWriter>> writer =
      ResultsWriter::open(folder, info, model->mesh(), [&tissue](const VecX& u) { return tissue.stress(u); });
  if (!writer) return writer.error();
  if (result.probe) (*writer)->add_probe(*result.probe);
  Recorder recorder(**writer, result.steps);
  Result<Summary> summary = settings.recorded.empty() ? run(model, recorder, progress)
                                                      : run_recorded(model, settings.recorded, recorder, progress);
  if (!summary) return summary.error();
  // The summary has the warnings of model and run; the notes of reader and mesher are added here.
  summary->warnings.insert(summary->warnings.begin(), prepared.notes.begin(), prepared.notes.end());
  if (result.map) {
    predict_holes(model, plan_of, *result.map, progress);
    (*writer)->add_map(*result.map);
  }
  if (Result<> finished = (*writer)->finish(*summary, progress, scenario.output.pictures); !finished)
    return finished.error();
  result.summary = std::move(*summary);
  return result;
}

}  // namespace stylet
