// SPDX-License-Identifier: GPL-3.0-or-later
// Rules about what the sources are: isotope, half-life, model, strength.
#include "dose/rules.hpp"
#include "stylet/dose/fitting_sources.hpp"

#include <algorithm>
#include <array>

namespace stylet::dose {

namespace {

constexpr double kLeastSeed_U = 0.03, kMostSeed_U = 100.0;
constexpr Range kAnySeed_U{kLeastSeed_U, 0.1, 10.0, kMostSeed_U};
constexpr double kShortDwell_s = 3600.0;

std::string of_kind(const Judged& judged, std::size_t kind) {
  return kind_count(judged.plan) == 1 ? std::string()
                                      : fmt::format(" of source '{}'", source_kind(judged.plan, kind).id);
}

void judge_isotope(const Judged& judged, std::size_t kind, Findings& found) {
  const SourceKind says = source_kind(judged.plan, kind);
  const SourceModel& model = judged.models[kind];
  const std::string isotope = isotope_of(says);
  const std::string of_model = isotope_name(model.isotope);
  if (!isotope.empty() && !model.isotope.empty() && isotope != of_model) {
    found.refuse(Rule::isotope_and_model, judged.plan.file,
                 fmt::format("the plan's sources{} are {}, and the source model {} is {}", of_kind(judged, kind),
                             isotope, model.name, model.isotope),
                 kind_count(judged.plan) == 1
                     ? fmt::format("Name a source model of {} (--source)", isotope)
                     : fmt::format("Name a source model of {} (--source {}=NAME)", isotope, says.id));
  }
  const bool named = !says.isotope.empty();
  if (!nuclide(isotope.empty() ? isotope_name(says.isotope) : isotope) && (named || judged.plan.says.is_dicom)) {
    found.warn(Rule::isotope_known,
               named ? fmt::format("The isotope{} '{}' is not known, and no half-life shows which it is; the model {} "
                                   "({}) is used",
                                   of_kind(judged, kind), says.isotope, model.name, model.isotope)
                     : fmt::format("The plan does not say its isotope{}; the model {} ({}) is used",
                                   of_kind(judged, kind), model.name, model.isotope));
  }
  const auto known = nuclide(isotope.empty() ? of_model : isotope);
  const auto differs = [](double a, double b) { return std::abs(a / b - 1.0); };
  if (says.half_life_days < 0.0 ||
      (says.half_life_days > 0.0 && known && differs(says.half_life_days, known->half_life_days) > kOtherHalfLife)) {
    found.refuse(Rule::half_life, judged.plan.file,
                 known ? fmt::format("the half-life{} is {:.6g} d, that of {} is {:g} d", of_kind(judged, kind),
                                     says.half_life_days, known->name, known->half_life_days)
                       : fmt::format("the half-life{} is {:.6g} d", of_kind(judged, kind), says.half_life_days),
                 "Correct isotope or half-life (in days) in the planning system and export the plan again");
  } else if (says.half_life_days > 0.0 && differs(says.half_life_days, model.half_life_days) > kSameHalfLife) {
    found.warn(Rule::half_life,
               fmt::format("The plan says a half-life{} of {:.6g} d, the source model {} has {:.6g} d; "
                           "the model's is used",
                           of_kind(judged, kind), says.half_life_days, model.name, model.half_life_days));
  }
  if (const auto of = nuclide(of_model); of && differs(model.half_life_days, of->half_life_days) > kOtherHalfLife) {
    found.refuse(Rule::half_life, "source model " + model.name,
                 fmt::format("its half-life is {:.6g} d, that of {} is {:g} d", model.half_life_days, of->name,
                             of->half_life_days),
                 "Correct isotope or half-life (in days) of the source model");
  }
  if (!fits_length(says, model)) {
    found.warn(Rule::source_length,
               fmt::format("The plan says a source{} of {:g} mm length; {} is {:g} mm long with an active part of {:g} "
                           "mm; check the model",
                           of_kind(judged, kind), says.source_length_mm, model.name, model.outer_length_mm,
                           model.active_length_mm));
  }
  if (!known) return;
  if (known->is_of_seeds == judged.temporary() && (judged.is_high_rate() || !judged.temporary())) {
    found.warn(Rule::isotope_and_implant, fmt::format("The plan is {}, and its sources{} are {}",
                                                      judged.temporary() ? "one of an afterloader" : "permanent",
                                                      of_kind(judged, kind), known->name));
  }
}

struct StrengthRule {
  Rule rule;
  Range range;
  const char* what;
};

StrengthRule strength_rule(const Judged& judged, std::size_t kind) {
  if (!judged.temporary()) {
    const auto known = nuclide(isotope_name(judged.models[kind].isotope));
    return {Rule::seed_strength, known && known->is_of_seeds ? known->seed_U : kAnySeed_U, "a seed"};
  }
  if (judged.plan.says.type == "PDR") return {Rule::afterloader_strength, kPulsed_U, "the source of a PDR afterloader"};
  if (judged.is_high_rate()) return {Rule::afterloader_strength, kAfterloader_U, "the source of an HDR afterloader"};
  return {Rule::low_rate_strength, kLowRate_U, "a source of low dose rate"};
}

void judge_strengths(const Judged& judged, std::size_t kind, Findings& found) {
  double least = INFINITY, most = 0.0;
  std::size_t of_least = 0, of_most = 0;
  for (std::size_t k = 0; k < judged.plan.sources.size(); ++k) {
    const PlannedSource& s = judged.plan.sources[k];
    if (s.kind != kind) continue;
    if (s.strength_U < least) least = s.strength_U, of_least = k + 1;
    if (s.strength_U > most) most = s.strength_U, of_most = k + 1;
  }
  if (most <= 0.0) return;
  const StrengthRule rule = strength_rule(judged, kind);
  for (const auto& [strength, number] : {std::pair(least, of_least), std::pair(most, of_most)}) {
    const std::string what =
        fmt::format("the air-kerma strength of source {} is {:g} U, {:g} … {:g} U is expected of {}", number, strength,
                    rule.range.low, rule.range.high, rule.what);
    if (!rule.range.possible(strength)) {
      found.refuse(rule.rule, judged.plan.file, what,
                   judged.temporary() ? "Give the strength in U = µGy m²/h"
                                      : "Give the strength in U = µGy m²/h; a text plan with dwell times needs "
                                        "\"implant\": \"temporary\"");
      return;
    }
    if (!rule.range.plausible(strength)) {
      found.warn(rule.rule, "T" + what.substr(1) + "; check the unit");
      break;
    }
  }
  if (most > kStrengthRatio * least) {
    found.warn(Rule::equal_strengths, fmt::format("The strengths{} differ: source {} has {:g} U, source {} has {:g} U",
                                                  of_kind(judged, kind), of_least, least, of_most, most));
  }
}

}  // namespace

std::span<const Nuclide> nuclides() {
  // Half-lives of the source models, and for the others those of NNDC.
  static constexpr std::array<Nuclide, 8> table{{
      {"I-125", 59.4, {kLeastSeed_U, 0.15, 2.5, kMostSeed_U}, true},
      {"Pd-103", 16.991, {kLeastSeed_U, 0.5, 6.0, kMostSeed_U}, true},
      {"Cs-131", 9.689, {kLeastSeed_U, 0.8, 8.0, kMostSeed_U}, true},
      {"Au-198", 2.695, {kLeastSeed_U, 1.0, 30.0, kMostSeed_U}, true},
      {"Ir-192", 73.83, kAnySeed_U, false},
      {"Co-60", 1925.0, kAnySeed_U, false},
      {"Yb-169", 32.02, kAnySeed_U, false},
      {"Cs-137", 10976.0, kAnySeed_U, false},
  }};
  return table;
}

std::optional<Nuclide> nuclide(std::string_view isotope) {
  for (const Nuclide& n : nuclides()) {
    if (n.name == isotope) return n;
  }
  return std::nullopt;
}

bool Judged::is_high_rate() const {
  if (!temporary()) return false;
  const std::string& type = plan.says.type;
  if (type == "HDR" || type == "MDR" || type == "PDR") return true;
  if (!type.empty()) return false;
  const bool seeds_only = std::all_of(models.begin(), models.end(), [](const SourceModel& model) {
    const auto known = nuclide(isotope_name(model.isotope));
    return known && known->is_of_seeds;
  });
  const bool weak = std::all_of(plan.sources.begin(), plan.sources.end(),
                                [](const PlannedSource& s) { return s.strength_U < kLowRate_U.high; });
  const bool is_long = std::all_of(plan.sources.begin(), plan.sources.end(),
                                   [](const PlannedSource& s) { return s.dwell_s >= kShortDwell_s; });
  return !seeds_only && !(weak && is_long);
}

void judge_sources(const Judged& judged, Findings& found) {
  for (std::size_t kind = 0; kind < judged.models.size() && kind < kind_count(judged.plan); ++kind) {
    judge_isotope(judged, kind, found);
    judge_strengths(judged, kind, found);
  }
  for (const std::string& unused : judged.plan.says.unused) {
    found.warn(Rule::unused_source, fmt::format("No channel of the plan uses source {}", unused));
  }
}

}  // namespace stylet::dose
