// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/implant_words.hpp"

#include "dose/structure_look.hpp"
#include "fixed_number.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace stylet::results {
namespace {

std::string paragraph(const std::string& text) { return "<p>" + html_prose(text) + "</p>"; }

std::string count_of(std::size_t number, const std::string& thing) {
  return fmt::format("{} {}{}", number, thing, number == 1 ? "" : "s");
}

/// "a", "a and b", "a, b and c".
std::string list_in_words(const std::vector<std::string>& parts) {
  std::string list;
  for (std::size_t k = 0; k < parts.size(); ++k)
    list += (k == 0 ? "" : k + 1 == parts.size() ? " and " : ", ") + parts[k];
  return list;
}

/// The mean shift along the axes where it is at least a tenth of a millimetre.
std::string mean_shift(const SeedErrors& errors) {
  std::vector<std::string> parts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double mean = errors.axes[axis].mean_mm;
    if (std::abs(mean) >= 0.1) parts.push_back(toward_text(mean, axis));
  }
  if (parts.empty()) return "Their mean shift is less than 0.1 mm along each axis.";
  return "Their mean shift is " + list_in_words(parts) + ".";
}

/// The mean shift of each third along the needles, which single numbers for all seeds do not show.
std::string shift_by_third(const ImplantHistory& history) {
  std::vector<std::string> parts;
  for (const PartErrors& third : errors_by_third(history)) {
    if (third.errors.seeds > 0)
      parts.push_back(toward_text(third.errors.axes[2].mean_mm, 2) + " in the " +
                      (third.name == "mid" ? "mid-gland" : third.name));
  }
  return parts.size() < 2 ? std::string()
                          : " Along the axis from inferior to superior it is " + list_in_words(parts) + ".";
}

/// How far dwell positions lie from their plan, and what happened between planning and delivery.
std::string dwell_sentences(const ImplantOutcome& outcome) {
  const ImplantHistory& history = outcome.history;
  const SeedErrors errors = seed_errors(history.seeds);
  std::string text = fmt::format(
      "The plan has {} in {}, which stay until the delivery. At the delivery the dwell positions are in tissue that "
      "lies {} mm from their planned places on average; 95 % of them within {} mm. ",
      count_of(history.seeds.size(), "dwell position"), count_of(history.needles.size(), "catheter"),
      fixed(errors.mean_mm, 1), fixed(errors.p95_mm, 1));
  text += mean_shift(errors) + shift_by_third(history);
  if (!outcome.at_planning) return text;
  const SeedErrors then = seed_errors(outcome.at_planning->history.seeds);
  double wait_mm = 0.0;
  Vec3 mean = Vec3::Zero();
  for (const CauseOfErrors& cause : causes_of_errors(history.seeds)) {
    if (cause.cause != SeedCause::wait) continue;
    wait_mm = cause.mean_mm;
    mean = cause.mean_vector_mm;
  }
  return text + fmt::format(
                    " On the images of the plan they were {} mm from it on average. In the {:g} s from there to the "
                    "delivery they moved by {} mm on average against the tissue, on the whole {}.",
                    fixed(then.mean_mm, 1), outcome.scenario.procedure.planning_to_delivery_s, fixed(wait_mm, 2),
                    toward_text(mean.z(), 2));
}

/// Whether the tissue goes back when the probe is taken out, to where the contours of the plan have it.
bool probe_goes_back(const ImplantOutcome& outcome) { return outcome.probe && !outcome.probe->settings.in_contours; }

std::string seed_sentences(const ImplantOutcome& outcome) {
  const ImplantHistory& history = outcome.history;
  const SeedErrors errors = seed_errors(history.seeds);
  const std::size_t lost = history.seeds.size() - errors.seeds;
  std::string text = fmt::format("The plan places {} with {}. ", count_of(history.seeds.size(), "seed"),
                                 count_of(history.needles.size(), "needle"));
  if (lost > 0) {
    text += fmt::format("Of them {} lost and {} no dose. ", lost == 1 ? "1 is" : fmt::format("{} are", lost),
                        lost == 1 ? "gives" : "give");
  }
  if (errors.seeds == 0) return text;
  return text +
         fmt::format(
             "With {}, the seeds lie {} mm from their planned places on average; 95 % of them lie within {} mm. ",
             probe_goes_back(outcome) ? "the probe and all needles out" : "all needles out", fixed(errors.mean_mm, 1),
             fixed(errors.p95_mm, 1)) +
         mean_shift(errors) + shift_by_third(history);
}

/// The dose once the probe is out, where the contours were drawn with the probe in place.
std::string probe_out_sentence(const ImplantOutcome& outcome) {
  if (!outcome.probe_out) return {};
  const StructureDose* in = find_region(outcome.delivered, "prostate");
  const StructureDose* out = find_region(*outcome.probe_out, "prostate");
  if (!in || !out) return {};
  return fmt::format(
      " The contours were drawn with the probe in place, and so is the delivered dose; with the probe out, gland and "
      "seeds go back together, and the target’s D90 is {} Gy.",
      fixed(out->dvh.dose_of_percent(90.0), 0));
}

std::string cause_sentence(const ImplantHistory& history) {
  const std::vector<CauseOfErrors> causes = causes_that_moved(history);
  const auto largest =
      std::max_element(causes.begin(), causes.end(),
                       [](const CauseOfErrors& a, const CauseOfErrors& b) { return a.mean_mm < b.mean_mm; });
  if (largest == causes.end()) return fmt::format("No cause moved a {}.", nouns_of(history).source);
  return fmt::format("The largest cause is {} ({} mm on average). {}", to_string(largest->cause),
                     fixed(largest->mean_mm, 1), meaning_of(largest->cause, implant_of(history.seeds)));
}

/// A figure of the target in both doses.
std::string changed(const char* name, double planned, double delivered, const char* unit, int digits) {
  return fmt::format("{} is {} {} in the plan and {} {} as delivered", name, fixed(planned, digits), unit,
                     fixed(delivered, digits), unit);
}

std::string dose_sentences(const ImplantOutcome& outcome) {
  const StructureDose* planned = find_region(outcome.planned, "prostate");
  const StructureDose* delivered = find_region(outcome.delivered, "prostate");
  std::string text;
  if (planned && delivered) {
    text =
        changed("The target’s D90", planned->dvh.dose_of_percent(90.0), delivered->dvh.dose_of_percent(90.0), "Gy", 0);
    if (const double prescription = outcome.delivered.prescription_Gy; prescription > 0.0) {
      text += "; " + changed("its V100", planned->dvh.percent_above(prescription),
                             delivered->dvh.percent_above(prescription), "%", 1);
    }
    text += ". ";
  }
  const auto met = [](const DoseEvaluation& dose) {
    return std::count_if(dose.goals.begin(), dose.goals.end(), [](const JudgedGoal& goal) { return goal.met; });
  };
  const auto judged = std::count_if(outcome.delivered.goals.begin(), outcome.delivered.goals.end(),
                                    [](const JudgedGoal& goal) { return goal.value.has_value(); });
  if (judged > 0) {
    text += fmt::format("Of {} goals that can be judged, the plan meets {} and the implant as delivered {}. ", judged,
                        met(outcome.planned), met(outcome.delivered));
  }
  if (has_oedema(outcome.scenario))
    text += "The delivered dose includes the swelling of the gland, which the plan does not know.";
  return text + probe_out_sentence(outcome);
}

}  // namespace

std::string signed_number(double value, int digits) {
  const std::string size = fixed(std::abs(value), digits);
  if (size.find_first_not_of("0.") == std::string::npos) return size;
  return (value < 0.0 ? "−" : "+") + size;
}

std::string toward_text(double value_mm, std::size_t axis) {
  return fixed(std::abs(value_mm), 1) + " mm to " + (axis == 0 ? "the " : "") +
         (value_mm < 0.0 ? kAgainst[axis] : kToward[axis]);
}

const ImplantNouns& nouns_of(Implant implant) {
  static const ImplantNouns permanent{"seed", "seeds", "needle", "needles"};
  static const ImplantNouns temporary{"dwell position", "dwell positions", "catheter", "catheters"};
  return implant == Implant::temporary ? temporary : permanent;
}

const ImplantNouns& nouns_of(const ImplantHistory& history) { return nouns_of(implant_of(history.seeds)); }

std::string capital(std::string noun) {
  if (!noun.empty()) noun.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(noun.front())));
  return noun;
}

std::vector<CauseOfErrors> causes_that_moved(const ImplantHistory& history) {
  constexpr double kNothing_mm = 5e-4;
  std::vector<CauseOfErrors> causes = causes_of_errors(history.seeds);
  std::erase_if(causes, [](const CauseOfErrors& cause) { return !(cause.mean_mm > kNothing_mm); });
  return causes;
}

std::string causes_left_out(const ImplantHistory& history) {
  const std::vector<CauseOfErrors> moved = causes_that_moved(history);
  std::vector<std::string> names;
  for (const SeedCause cause : causes_of(implant_of(history.seeds))) {
    if (std::none_of(moved.begin(), moved.end(), [&](const CauseOfErrors& c) { return c.cause == cause; }))
      names.emplace_back(to_string(cause));
  }
  if (names.empty()) return {};
  return fmt::format("The picture leaves out {}, which moved no {} in this implant.", list_in_words(names),
                     nouns_of(history).source);
}

std::string implant_story(const ImplantOutcome& outcome) {
  const bool temporary = implant_of(outcome.history.seeds) == Implant::temporary;
  std::string story = paragraph((temporary ? dwell_sentences(outcome) : seed_sentences(outcome)) + " " +
                                cause_sentence(outcome.history));
  const std::string dose = dose_sentences(outcome);
  return dose.empty() ? story : story + paragraph(dose);
}

bool has_oedema(const Scenario& scenario) {
  const auto& percent = scenario.oedema.swelling_percent;
  return std::any_of(percent.begin(), percent.end(), [](double p) { return p != 0.0; });
}

}  // namespace stylet::results
