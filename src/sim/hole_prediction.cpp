// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/parallel.hpp"
#include "stylet/sim/hole_map.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

namespace stylet {

namespace {

/// Largest total number of nodes of the meshes that are compiled in parallel; it limits the memory.
constexpr Index kNodesAtOnce = 40000;

}  // namespace

Result<Prediction> predict_hole(Scenario scenario, const TetMesh& mesh, const InsertionPlan& plan,
                                KnownTargets& targets, const Progress& progress, const OwnParts& own) {
  scenario.insertions = {plan};
  auto compiled = Model::compile(scenario, mesh, "hole " + plan.hole.value_or(""), {}, progress);
  if (compiled && own.is_any()) compiled = (*compiled)->with(own);
  if (!compiled) return compiled.error();
  return predict(*compiled, targets, progress);
}

void predict_holes(const std::shared_ptr<const Model>& model, const PlanOfHole& plan_of, HoleMap& map,
                   const Progress& progress) {
  const Scenario& scenario = model->scenario();
  KnownTargets targets;
  const auto caller = std::this_thread::get_id();
  const auto count = map.holes.size();
  const auto lanes = static_cast<std::size_t>(std::max<Index>(1, kNodesAtOnce / model->mesh().node_count()));
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> done = 0;
  for_each_in_parallel(std::min(lanes, count), [&](std::size_t /*lane*/) {
    for (std::size_t i = next++; i < count; i = next++) {
      if (std::this_thread::get_id() == caller)
        report(progress, "predicting each hole", static_cast<double>(done) / static_cast<double>(count));
      HoleRow& row = map.holes[i];
      if (row.failed.empty()) {
        const InsertionPlan plan = plan_of(row.hole);
        const bool is_the_models = scenario.insertions.size() == 1 && scenario.insertions.front() == plan;
        auto predicted = is_the_models ? predict(model, targets)
                                       : predict_hole(scenario, model->mesh(), plan, targets, {}, model->own_parts());
        if (predicted) {
          row.prediction = std::move(*predicted);
        } else {
          row.failed = predicted.error().message();
        }
      }
      ++done;
    }
  });
}

}  // namespace stylet
