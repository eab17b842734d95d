// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/prediction.hpp"

#include "base_steps.hpp"
#include "needles_in_place.hpp"
#include "stylet/core/flush_denormals.hpp"
#include "stylet/sim/gland_watch.hpp"

namespace stylet {

namespace {

constexpr long kReportEvery = 64;     // steps between two reports of progress
constexpr std::size_t kMostKept = 3;  // cached target motions, each of which keeps its model in memory

std::vector<std::string> names_of_target(const Model& model) {
  std::vector<std::string> names;
  for (const int region : model.target_regions())
    names.push_back(model.mesh().regions[static_cast<std::size_t>(region)]);
  return names;
}

}  // namespace

Result<TargetMotion> KnownTargets::of(const std::shared_ptr<const Model>& model, const Progress& progress) {
  {
    const std::scoped_lock lock(mutex_);
    for (const Known& known : known_) {
      if (auto shared = known.motion.shared_with(*model)) return std::move(*shared);
    }
  }
  auto motion = TargetMotion::of(*model, progress);
  if (!motion) return motion;
  const std::scoped_lock lock(mutex_);
  if (known_.size() < kMostKept && motion->shared_with(*model)) known_.push_back({model, *motion});
  return motion;
}

Result<Prediction> predict(const std::shared_ptr<const Model>& model, KnownTargets& targets, const Progress& progress) {
  const FlushDenormals flush;  // as in run(), so that the results are equal
  const PlannedInsertion& insertion = model->insertions().front();
  const BaseSteps motion = planned_steps(*model, insertion);
  const long deepest = deepest_step(*model, insertion, motion);

  std::optional<TargetMotion> target;
  std::optional<GlandWatch> gland;
  if (!model->target_regions().empty()) {
    auto response = targets.of(model, progress);
    if (!response) return response.error();
    target = std::move(*response);
    gland.emplace(names_of_target(*model));
  }

  Simulation simulation(model, needles_of(*model));
  auto remarks_in_place = put_in_staying_needles(simulation, progress);
  if (!remarks_in_place) return remarks_in_place.error();
  std::optional<BesideNeedles> beside;
  if (!model->staying().empty()) {
    beside.emplace(simulation, target ? &*target : nullptr, names_of_target(*model), motion.base(deepest),
                   *std::move(remarks_in_place));
  }
  StepRemarks remarks;
  const auto watch = [&](long k, const Step& step, double) -> Result<> {
    remarks.add(simulation);
    if (gland) {
      const TargetMotion::Moment now = target->now(simulation.insertion());
      gland->add(step, simulation.new_events(), now.motion, now.at_rest, k == deepest);
      if (beside) beside->add(step, simulation.new_events(), now.motion, now.at_rest, k == deepest);
    }
    if (k % kReportEvery == 0)
      report(progress, "inserting " + insertion.name, static_cast<double>(k) / static_cast<double>(deepest));
    return Ok{};
  };
  if (Result<> done = drive(simulation, motion, deepest, watch); !done) return done.error();

  Prediction result;
  if (gland) {
    const GlandMotion moved = gland->result();
    result.shift_at_break_mm = moved.shift_at_break_mm;
    result.shift_max_mm = moved.shift_max_mm;
  }
  result.tip_error_mm = tip_error_mm(simulation.insertion(), simulation.last_step());
  if (beside) result.in_place = beside->result(result.tip_error_mm);
  result.remarks = remarks.sentences();
  return result;
}

}  // namespace stylet
