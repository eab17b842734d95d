// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/implant_plan.hpp"

#include "stylet/dose/plan_rules.hpp"
#include "stylet/io/input.hpp"
#include "stylet/io/scenario_plan.hpp"
#include "stylet/patient/source_choice.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet {

namespace {

Result<PatientInput> patient_input(const Scenario& scenario) {
  if (scenario.patient.source == "phantom") return PatientInput(demo_patient());
  return read_input(scenario.patient.source,
                    {.scale = scenario.patient.scale, .regions_from = scenario.patient.regions_from},
                    {.volume = scenario.patient.volume}, scenario.patient.skip);
}

Result<DoseStructures> structures_of(const Scenario& scenario, const DosePlan& plan, const Progress& progress) {
  const Result<PatientInput> input = patient_input(scenario);
  if (!input) return input.error();
  DoseStructureOptions options;
  options.regions = scenario.patient.regions;
  options.skip = scenario.patient.skip;
  Result<DoseStructures> structures = dose_structures(*input, options, progress);
  if (!structures) return structures;
  if (!structures->frame_of_reference.empty() && !plan.frame_of_reference.empty() &&
      structures->frame_of_reference != plan.frame_of_reference) {
    return input_error(plan.file,
                       fmt::format("the plan has the frame of reference {}, the patient's structures have {}",
                                   plan.frame_of_reference, structures->frame_of_reference),
                       "Give the plan of this patient");
  }
  return structures;
}

/// The point about which the gland swells: the centre of the target's samples; without a target, of the seeds.
Vec3 centre_of(const DoseStructures& structures, const DosePlan& plan) {
  Vec3 sum = Vec3::Zero();
  for (const DoseStructure& structure : structures.structures) {
    if (structure.region != "prostate") continue;
    for (const Vec3& x : structure.samples.points) sum += x;
    return sum / static_cast<double>(std::max<std::size_t>(1, structure.samples.points.size()));
  }
  for (const PlannedSource& source : plan.sources) sum += source.at_mm;
  return sum / static_cast<double>(plan.sources.size());
}

Result<DoseOptions> dose_options(const Scenario& scenario, const DoseStructures& structures, const DosePlan& plan,
                                 const std::string& where) {
  DoseOptions options;
  Result<std::optional<std::vector<DoseGoal>>> goals = goals_of_scenario(scenario, where);
  if (!goals) return goals.error();
  if (*goals) {
    options.goals = **std::move(goals);
  } else if (plan.implant == Implant::permanent) {  // the program's own goals are those of permanent implants
    const auto own = permanent_prostate_goals();
    options.goals.assign(own.begin(), own.end());
  }
  const auto& percent = scenario.oedema.swelling_percent;
  options.swelling = {.centre_mm = centre_of(structures, plan),
                      .at_start = Vec3(percent[0], percent[1], percent[2]) / 100.0,
                      .half_life_days = scenario.oedema.half_life_days};
  return options;
}

/// A key of the scenario that has no meaning in a temporary implant is refused, since the user expects an effect of it.
Result<> check_temporary_scenario(const Scenario& scenario, const std::string& where) {
  struct Choice {
    bool is_made;
    const char* key;
    std::string value;
    const char* why;
  };
  const Scenario::Seed& seed = scenario.seed;
  const auto& percent = scenario.oedema.swelling_percent;
  const Choice choices[] = {
      {scenario.procedure.technique == SeedTechnique::pushed, "procedure.technique", "\"pushed\"",
       "no seed is pushed out of a catheter"},
      {seed.stranded, "seed.stranded", "true", "the dwell positions of a catheter are no strand of seeds"},
      {seed.release_mm != 0.0, "seed.release_mm", fmt::format("{:g}", seed.release_mm), "no seed is released"},
      {seed.release_sd_mm != 0.0, "seed.release_sd_mm", fmt::format("{:g}", seed.release_sd_mm), "no seed is released"},
      {seed.loss_percent != 0.0, "seed.loss_percent", fmt::format("{:g}", seed.loss_percent), "no seed can be lost"},
      {percent[0] != 0.0 || percent[1] != 0.0 || percent[2] != 0.0, "oedema.swelling_percent",
       fmt::format("[{:g}, {:g}, {:g}]", percent[0], percent[1], percent[2]),
       "the swelling of the program is that of the weeks in which seeds decay"}};
  for (const Choice& choice : choices) {
    if (!choice.is_made) continue;
    return input_error(where,
                       fmt::format("the plan is a temporary implant, and {} = {} is for permanent ones: {}", choice.key,
                                   choice.value, choice.why),
                       fmt::format("Leave {} out", choice.key));
  }
  return Ok{};
}

/// Needles of [[plan.needle]] may say themselves whether their seeds are a strand.
void say_which_are_stranded(const Scenario::ImplantPlan& plan, std::vector<NeedleLoad>& needles) {
  for (std::size_t k = 0; k < plan.needles.size(); ++k) {
    const std::string name = name_of_plan_needle(plan, k);
    for (NeedleLoad& needle : needles) {
      if (needle.name == name) needle.stranded = plan.needles[k].stranded;
    }
  }
}

}  // namespace

Result<ImplantPlan> read_implant_plan(const Scenario& scenario, const std::string& where, const Progress& progress) {
  ImplantPlan out;
  Result<DosePlan> plan = plan_of_scenario(scenario, where);
  if (!plan) return plan.error();
  out.plan = *std::move(plan);
  if (kind_count(out.plan) > 1) {
    return input_error(out.plan.file,
                       fmt::format("the plan has {} kinds of source, one is expected", kind_count(out.plan)),
                       "Simulate a plan with one kind of source; stylet dose computes plans with several");
  }
  const Result<std::vector<SourceModel>> models = choose_sources({scenario.plan.source}, out.plan);
  if (!models) return models.error();
  out.source = models->front();
  const bool temporary = out.plan.implant == Implant::temporary;
  if (temporary) {
    if (Result<> possible = check_temporary_scenario(scenario, where); !possible) return possible.error();
  }
  Result<std::vector<NeedleLoad>> needles =
      temporary ? load_catheters(out.plan, scenario.procedure.catheter_tip_mm)
                : load_needles(out.plan, out.source.outer_length_mm, scenario.procedure.plug_mm);
  if (!needles) return needles.error();
  out.needles = *std::move(needles);
  say_which_are_stranded(scenario.plan, out.needles);
  order_needles(out.needles, scenario.procedure.order);
  Result<DoseStructures> structures = structures_of(scenario, out.plan, progress);
  if (!structures) return structures.error();
  out.structures = *std::move(structures);
  Result<DoseOptions> options = dose_options(scenario, out.structures, out.plan, where);
  if (!options) return options.error();
  out.options = *std::move(options);
  // The plan is judged as it is written; where its seeds come to rest is a result, not a fault of the plan.
  const Result<std::vector<std::string>> doubts = judge_plan(out.plan, *models, out.structures.structures, out.options);
  if (!doubts) return doubts.error();
  out.plan.notes.insert(out.plan.notes.end(), doubts->begin(), doubts->end());
  out.options.judged = true;
  return out;
}

}  // namespace stylet
