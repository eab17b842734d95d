// SPDX-License-Identifier: GPL-3.0-or-later
// The table of rules for plans, and the order in which they judge.
#include "stylet/dose/plan_rules.hpp"

#include "dose/rules.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace stylet {

namespace dose {

namespace {

std::string warned_and_refused(const Range& range, const char* unit) {
  return fmt::format("warned of outside {:g} … {:g}{}; refused outside {:g} … {:g}{}", range.low, range.high, unit,
                     range.least, range.most, unit);
}

std::string seed_bounds() {
  std::string text;
  for (const Nuclide& n : nuclides()) {
    if (n.is_of_seeds)
      text += fmt::format("{}{} {:g} … {:g} U", text.empty() ? "" : ", ", n.name, n.seed_U.low, n.seed_U.high);
  }
  return text;
}

std::string half_lives() {
  std::string text;
  for (const Nuclide& n : nuclides())
    text += fmt::format("{}{} {:g} d", text.empty() ? "" : ", ", n.name, n.half_life_days);
  return text;
}

/// The rules in the order of the enumeration.
std::vector<PlanRule> made_rules() {
  const std::string warned = "warned of", refused = "refused";
  const Range seed = nuclides().front().seed_U;
  return {
      {"isotope and model", "the isotope of a source is that of its source model", refused,
       "half-life and tables of another isotope give another dose"},
      {"known isotope",
       "the isotope's name, or the half-life, is one of the table of isotopes, or the plan says "
       "neither because it names the model",
       warned, "nothing shows that the source model fits"},
      {"half-life", fmt::format("the half-life in the file is that of isotope and model ({})", half_lives()),
       fmt::format("warned of above {:g} % of difference; refused above {:g} %", 100 * kSameHalfLife,
                   100 * kOtherHalfLife),
       "a permanent implant's dose is proportional to it; a file that names one isotope with the half-life of another "
       "one, or in hours, contradicts itself"},
      {"source length", "the length of the active part is that of the model, within 0.5 mm", warned,
       "the model may be another one"},
      {"seed strength", "strength of a seed that stays: " + seed_bounds(),
       fmt::format("warned of outside; refused outside {:g} … {:g} U", seed.least, seed.most),
       "strengths of seeds for prostate implants with a margin of two or more; numbers in MBq, kBq or Bq, in Gy m²/h, "
       "or of an afterloader lie outside. Numbers in mCi do not (1 mCi of I-125 is 1.27 U): the dose to the target "
       "shows them at most"},
      {"afterloader strength",
       fmt::format("strength of an afterloader's source in U (HDR; PDR: {:g} … {:g} U)", kPulsed_U.low, kPulsed_U.high),
       warned_and_refused(kAfterloader_U, " U") + fmt::format(" (PDR: {:g} … {:g} U)", kPulsed_U.least, kPulsed_U.most),
       "10 Ci of Ir-192 are about 40,800 U, exchanged after one to two half-lives; numbers in Ci, GBq, MBq, mGy/h or "
       "cGy/h at 1 m lie outside"},
      {"low-rate strength", "strength of a source that lies for hours or days and is taken out",
       warned_and_refused(kLowRate_U, " U"), "between weak seeds and the strongest sources of low dose rate"},
      {"equal strengths",
       fmt::format("the strongest source of a kind has at most {:g} times the strength of the weakest", kStrengthRatio),
       warned, "seeds of one order differ by less; a single number with another unit or a lost digit shows"},
      {"isotope and implant", "I-125, Pd-103, Cs-131 and Au-198 stay; Ir-192, Co-60 and Yb-169 are taken out", warned,
       "the usual use of these isotopes"},
      {"type and technique",
       "the technique (300A,0200) is PERMANENT only with the type (300A,0202) LDR or MANUAL; sources that are computed "
       "as staying have the technique PERMANENT and a time that is not shorter than their mean life",
       "refused: PERMANENT with HDR, MDR or PDR; the rest is warned of",
       "the dose of sources that stay is thousands of times that of a dwell time"},
      {"dwell times of seeds", "a permanent implant has no dwell times", refused,
       "they would be dropped; without \"implant\": \"temporary\" a JSON or CSV plan is permanent"},
      {"missing dwell time", "each source of a temporary implant has a dwell time, and one of them is above 0", refused,
       "a source without its time would give no dose"},
      {"channel time",
       "a channel (temporary implants in DICOM) whose places have weights has a time (300A,0286), and one with a time "
       "has weights",
       "refused where the time is missing or empty; warned of where it is 0, or where a time has no weights",
       "the weights are parts of this time; the dose of the channel would be missing"},
      {"channel weights",
       fmt::format("the weights of a channel's places add up to its final cumulative time weight (300A,02C8) within "
                   "{:g} %",
                   100 * kSameWeights),
       warned, "the channel's time is divided by the one or by the other"},
      {"control points", "a channel has as many control points as it announces (300A,0110)", warned,
       "places may be missing"},
      {"time of the implant",
       "all dwell times of an afterloader's plan together; sources of low dose rate lie for 1 h to 60 d",
       warned_and_refused(kHighRate_s, " s") + "; the rest is warned of",
       "treatments take minutes; times in ms, min or h lie outside"},
      {"pulses", "a PDR plan has more than one pulse (300A,028A), and other plans have at most one", warned,
       "the times are multiplied by the pulses of PDR only"},
      {"total air kerma",
       fmt::format(
           "the total reference air kerma (300A,0250), where it is above 0, is strength times time of its setup "
           "or of the plan within {:g} %",
           100 * kSameKerma),
       warned, "the file's own sum of strengths and times contradicts them"},
      {"prescription",
       fmt::format("the prescribed dose: {:g} … {:g} Gy for sources that stay, {:g} … {:g} Gy for the others",
                   kPermanent_Gy.low, kPermanent_Gy.high, kFraction_Gy.low, kFraction_Gy.high),
       fmt::format("warned of outside; refused outside {:g} … {:g} Gy and {:g} … {:g} Gy", kPermanent_Gy.least,
                   kPermanent_Gy.most, kFraction_Gy.least, kFraction_Gy.most),
       "boosts of 40 Gy and more to 145 Gy and salvage; one fraction of HDR to PDR of days; numbers in cGy lie "
       "outside"},
      {"missing prescription", "a plan with a target has a prescribed dose", warned,
       "figures in per cent and goals need it"},
      {"one prescription",
       "all prescribed doses to targets agree; the dose of the setups is that of the target, or of one of its "
       "fractions; --prescription is within a factor of 1.5 of the plan's",
       warned, "only one of them is used"},
      {"fractions", "a permanent implant has one fraction, others have 1 … 40", warned,
       "the dose is that of one fraction"},
      {"dates",
       fmt::format(
           "the strength's date is a date, at most {:g} days after plan and computation, and the plan's date is "
           "not in the future; between the two the strength decays by less than 1 %, or --decay-days is given. "
           "Dates before 1970 stand for none",
           kPlanBefore_days),
       warned, "strengths count as those at the implant"},
      {"unused source", "each source with a strength and a half-life is used by a channel", warned,
       "seeds or channels may be missing"},
      {"same place", fmt::format("no two sources lie within {:g} mm of each other", kSamePlace_mm), warned,
       "a copied line; all are counted. In DICOM plans that repeat their seeds in other setups each counts once, which "
       "is told"},
      {"overlapping seeds", "the centres of two seeds are not nearer than their capsule is thick", warned,
       "two capsules cannot be at one place; coordinates in cm or m bring seeds together"},
      {"extent",
       fmt::format("the sources lie within {:g} mm; ten sources or more are spread over {:g} mm at least", kWidest_mm,
                   kNarrowest_mm),
       warned, "coordinates in another unit"},
      {"distance from the target",
       fmt::format("no source is further than {:g} mm from the target, and half of them lie within {:g} mm of it",
                   kFarFromTarget_mm, kBesideTarget_mm),
       warned, "margins are a few millimetres, seminal vesicles some 15 mm"},
      {"other patient",
       fmt::format("a source lies within {:g} mm of the target (without one: of any structure)", kOtherPatient_mm),
       refused, "plan and structures belong to different patients or frames, or have different units"},
      {"number of sources",
       fmt::format("{} to {} seeds for a target of more than 5 cc; at most {} dwell positions", kFewSeeds, kManySeeds,
                   kManyDwells),
       warned, "implants of the prostate have 30 to 150 seeds"},
      {"target",
       fmt::format("one structure is taken as the target (region prostate), and it has {:g} … {:g} cc", kTarget_cc.low,
                   kTarget_cc.high),
       warned, "without a target no figure says whether the plan is good; an empty or huge one is another organ"},
      {"not computed", "the plan has no shields, no external beams, and no entry that nothing uses", warned,
       "their effect is not in the dose"},
      {"dose to the target",
       fmt::format("D90 of the target is {:g} to {:g} times the prescription (total dose)", kTargetShare.low,
                   kTargetShare.high),
       fmt::format("warned of outside; refused above {:g} times for targets of 5 cc or more", kTargetShare.most),
       "strength, time or prescription in another unit, or a plan that is not for this target"},
  };
}

}  // namespace

void Findings::warn(Rule rule, std::string sentence) {
  const std::string& name = plan_rules()[static_cast<std::size_t>(rule)].name;
  if (sentence.ends_with('.')) sentence.pop_back();
  sentences_.push_back(fmt::format("{} (rule “{}”).", sentence, name));
}

void Findings::refuse(Rule rule, const std::string& where, const std::string& what, const std::string& cure) {
  const std::string& name = plan_rules()[static_cast<std::size_t>(rule)].name;
  if (!error_) error_ = input_error(where, fmt::format("{} (rule “{}”)", what, name), cure);
}

Result<std::vector<std::string>> Findings::result() {
  if (error_) return *error_;
  return std::move(sentences_);
}

}  // namespace dose

std::span<const PlanRule> plan_rules() {
  static const std::vector<PlanRule> rules = dose::made_rules();
  return rules;
}

Result<std::vector<std::string>> judge_plan(const DosePlan& plan, std::span<const SourceModel> models,
                                            std::span<const DoseStructure> structures, const DoseOptions& options) {
  dose::Findings found;
  const dose::Judged judged{plan, models, structures, options};
  judge_times(judged, found);
  judge_sources(judged, found);
  judge_prescription(judged, found);
  judge_places(judged, found);
  return found.result();
}

Result<std::vector<std::string>> judge_dose(const DoseEvaluation& e) {
  dose::Findings found;
  const auto target = std::find_if(e.structures.begin(), e.structures.end(),
                                   [](const StructureDose& s) { return s.region == "prostate"; });
  if (target == e.structures.end() || e.prescription_Gy <= 0.0) return found.result();
  const double d90 = target->dvh.dose_of_percent(90.0);
  const double share = d90 / e.prescription_Gy;
  const std::string what = fmt::format("D90 of the target '{}' is {:.4g} Gy, {:.2g} times the prescription of {:g} Gy",
                                       target->name, d90, share, e.prescription_Gy);
  if (!dose::kTargetShare.possible(share) && target->dvh.volume_cc() >= 5.0) {
    found.refuse(dose::Rule::target_dose, e.plan.file, what,
                 "Check the units of strengths [U], times [s] and prescription [Gy], and that this is the target");
  } else if (!dose::kTargetShare.plausible(share)) {
    found.warn(dose::Rule::target_dose,
               what + "; check the units of strengths, times and prescription, and that this is the target");
  }
  return found.result();
}

}  // namespace stylet
