// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/procedure_facts.hpp"

#include "implant/implant_words.hpp"
#include "report/html_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace stylet::results {
namespace {

std::string technique_text(SeedTechnique technique) {
  switch (technique) {
    case SeedTechnique::preloaded:
      return "preloaded: the cannula is drawn back over a stylet that stays";
    case SeedTechnique::pushed:
      return "pushed: the needle stops at each seed, which the stylet pushes out";
  }
  return {};
}

/// @param needle noun for the needles of the plan
std::string order_text(NeedleOrder order, const char* needle) {
  switch (order) {
    case NeedleOrder::plan:
      return "as in the plan";
    case NeedleOrder::anterior_first:
      return fmt::format("the most anterior {} first", needle);
    case NeedleOrder::posterior_first:
      return fmt::format("the most posterior {} first", needle);
  }
  return {};
}

std::string together_text(NeedlesTogether together) {
  switch (together) {
    case NeedlesTogether::one:
      return "one at a time";
    case NeedlesTogether::row:
      return "all needles at one height of the template are in the tissue before the first of them drops its seeds";
    case NeedlesTogether::all:
      return "all needles are in the tissue before the first of them drops its seeds";
  }
  return {};
}

std::string stabilising_text(const std::vector<std::string>& holes) {
  if (holes.empty()) return "none";
  return fmt::format("{}, from the first needle to the last", fmt::join(holes, ", "));
}

std::string strand_text(const Scenario& scenario) {
  std::string text = scenario.seed.stranded ? "stranded: the seeds of a needle keep their distances"
                                            : "loose: each seed moves with the tissue around it";
  const auto& needles = scenario.plan.needles;
  const auto others = std::count_if(needles.begin(), needles.end(), [&](const Scenario::PlanNeedle& needle) {
    return needle.stranded.value_or(scenario.seed.stranded) != scenario.seed.stranded;
  });
  if (others > 0)
    text += fmt::format("; in {} of {} needles they are {}", others, needles.size(),
                        scenario.seed.stranded ? "loose" : "stranded");
  return text;
}

std::string release_text(const Scenario::Seed& seed) {
  if (seed.release_mm == 0.0 && seed.release_sd_mm == 0.0) return "a seed stays where it is let go";
  return fmt::format("a jump of {:g} ± {:g} mm along the track (mean ± standard deviation)", seed.release_mm,
                     seed.release_sd_mm);
}

std::string oedema_text(const Scenario& scenario) {
  if (!has_oedema(scenario)) return "none: the gland does not swell";
  const auto& percent = scenario.oedema.swelling_percent;
  return fmt::format(
      "the gland swells by {:g}, {:g} and {:g} % along left, posterior and superior, and shrinks with a half-life of "
      "{:g} days",
      percent[0], percent[1], percent[2], scenario.oedema.half_life_days);
}

}  // namespace

namespace {

/// How catheters go in and what is waited for.
std::string catheter_facts(const Scenario& scenario) {
  const Scenario::Procedure& procedure = scenario.procedure;
  return definition("Technique", "catheters go in one after the other, their hubs are locked, and all stay") +
         definition("Order of the catheters", order_text(procedure.order, "catheter")) +
         definition("Stabilising needles", stabilising_text(procedure.stabilising)) +
         definition("Speed of insertion", fmt::format("{:g} mm/s", procedure.speed_mm_per_s)) +
         definition("From the last catheter to the images of the plan", fmt::format("{:g} s", procedure.pause_s)) +
         definition("From these images to the delivery", fmt::format("{:g} s", procedure.planning_to_delivery_s)) +
         definition("From a catheter’s tip to its most distal dwell position",
                    fmt::format("{:g} mm", procedure.catheter_tip_mm));
}

}  // namespace

std::string procedure_facts(const Scenario& scenario, Implant implant) {
  if (implant == Implant::temporary) return catheter_facts(scenario);
  const Scenario::Procedure& procedure = scenario.procedure;
  return definition("Technique", technique_text(procedure.technique)) +
         definition("Order of the needles", order_text(procedure.order, "needle")) +
         definition("Needles together", together_text(procedure.together)) +
         definition("Stabilising needles", stabilising_text(procedure.stabilising)) +
         definition("Speed of insertion", fmt::format("{:g} mm/s", procedure.speed_mm_per_s)) +
         definition("Pause at full depth", fmt::format("{:g} s", procedure.pause_s)) +
         definition("Speed of withdrawal over the seeds", fmt::format("{:g} mm/s", procedure.drop_speed_mm_per_s)) +
         definition("Speed of withdrawal after them", fmt::format("{:g} mm/s", procedure.retract_speed_mm_per_s)) +
         definition("Plug between tip and first seed",
                    procedure.plug_mm > 0.0 ? fmt::format("{:g} mm", procedure.plug_mm) : "none");
}

std::string seed_facts(const Scenario& scenario, Implant implant) {
  if (implant == Implant::temporary) {
    return definition("Dwell positions", "each stays at its distance from the tip of its catheter") +
           definition("Oedema", "none but what the tissue’s creep is: the gland does not swell");
  }
  const Scenario::Seed& seed = scenario.seed;
  return definition("Seeds", strand_text(scenario)) + definition("Release", release_text(seed)) +
         definition("Loss", seed.loss_percent > 0.0
                                ? fmt::format("each seed is lost with a probability of {:g} %", seed.loss_percent)
                                : "no seed is lost") +
         definition("Oedema", oedema_text(scenario));
}

std::string tissue_facts(const Scenario& scenario, int nodes) {
  return definition("Tissue", fmt::format("preset “{}”{}", word(scenario.tissue_model.preset),
                                          scenario.tissue.empty() ? "" : ", with values of the scenario")) +
         definition("Creep of the tissue", fmt::format("final to immediate displacement {:.3g}, time constant {:g} s",
                                                       creep_of(scenario), scenario.tissue_model.creep_s)) +
         definition("Needle", fmt::format("{}, {:g} mm in diameter, {:g} mm long", word(scenario.needle.model),
                                          scenario.needle.diameter_mm, scenario.needle.length_mm)) +
         definition("Mesh", fmt::format("{} nodes", nodes)) +
         definition("Time step", fmt::format("{:g} ms", scenario.run.dt_ms));
}

}  // namespace stylet::results
