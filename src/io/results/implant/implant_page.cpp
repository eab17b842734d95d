// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/implant_page.hpp"

#include "dose/dose_text.hpp"
#include "dose/dvh_table.hpp"
#include "dose/page_data.hpp"
#include "dose/page_record.hpp"
#include "dose/page_shell.hpp"
#include "dose/page_tables.hpp"
#include "dose/structure_look.hpp"
#include "implant/choice_sections.hpp"
#include "implant/found_section.hpp"
#include "implant/implant_data.hpp"
#include "implant/implant_tables.hpp"
#include "implant/implant_words.hpp"
#include "implant/kind_words.hpp"
#include "implant/oedema_section.hpp"
#include "implant/procedure_facts.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::results {
namespace {

/// All histograms at the same doses, which reach as far as the hottest of them does.
struct AllDvh {
  DvhTable planned, delivered;
  std::optional<DvhTable> found;
};

AllDvh all_dvh(const ImplantOutcome& outcome) {
  std::vector<double> dose_Gy;
  const auto reach = [&](const DoseEvaluation& dose) {
    DvhTable table = dvh_table(dose);
    if (dose_Gy.empty() || table.dose_Gy.back() > dose_Gy.back()) dose_Gy = std::move(table.dose_Gy);
  };
  reach(outcome.planned);
  reach(outcome.delivered);
  if (outcome.found) reach(outcome.found->dose);
  AllDvh dvh{.planned = dvh_at(outcome.planned, dose_Gy), .delivered = dvh_at(outcome.delivered, dose_Gy), .found = {}};
  if (outcome.found) dvh.found = dvh_at(outcome.found->dose, dose_Gy);
  return dvh;
}

/// The doses of the tables of goals and figures.
std::vector<NamedDose> doses_of(const ImplantOutcome& outcome) {
  std::vector<NamedDose> doses{{"Planned", &outcome.planned}};
  if (outcome.at_planning) doses.push_back({"At planning", &outcome.at_planning->delivered});
  doses.push_back({"Delivered", &outcome.delivered});
  if (outcome.probe_out) doses.push_back({"Probe out", &*outcome.probe_out});
  if (!outcome.found) return doses;
  doses.push_back({"Found", &outcome.found->dose});
  if (outcome.found->comparison.matching.shift_beyond_chance())
    doses.push_back({"Found, without common shift", &outcome.found->dose_without_shift});
  return doses;
}

/// Where the probe is, its force, and how it deforms the gland; nothing without a probe.
std::string probe_definitions(const ImplantOutcome& outcome) {
  std::string facts;
  if (!outcome.probe) return facts;
  for (const ProbeFact& fact : probe_facts(*outcome.probe)) facts += definition(capital(fact.name), fact.text);
  return facts;
}

/// Whether any needle is in the tissue together with another one.
bool needles_together(const ImplantHistory& history) {
  return std::any_of(history.needles.begin(), history.needles.end(), [](const NeedleHistory& needle) {
    return std::any_of(needle.record.shapes.begin(), needle.record.shapes.end(),
                       [](const NeedleShape& shape) { return shape.when == kAllInPlace; });
  });
}

}  // namespace

Result<std::string> implant_page(const ImplantOutcome& outcome) {
  const ImplantHistory& history = outcome.history;
  const std::vector<NamedDose> doses = doses_of(outcome);
  const std::vector<std::string> colours = structure_colours(outcome.delivered.structures);
  const AllDvh dvh = all_dvh(outcome);
  const DvhTable* found = dvh.found ? &*dvh.found : nullptr;
  const Implant implant = implant_of(history.seeds);
  std::string choices;
  for (const ChoiceSection& section : choice_sections(outcome)) choices += choice_html(section, outcome);
  Slots slots{
      {"kicker",
       implant == Implant::temporary ? "Simulation of a temporary implant (HDR)" : "Simulation of a seed implant"},
      {"kind", "simulation"},
      {"title", html_escaped(outcome.scenario.name) + " – implant report"},
      {"heading", html_escaped(outcome.scenario.name)},
      {"facts", html_prose(plan_line(outcome.planned))},
      {"more_css", printed_margins(outcome.planned)},
      {"record", record_of(outcome.planned)},
      {"warnings", box_of_warnings(outcome.warnings)},
      {"tiles", implant_tiles(outcome)},
      {"story", implant_story(outcome)},
      {"goals", goal_table(doses)},
      {"chart_note", chart_note("summary.json")},
      {"dvh_file", "delivered/dvh.csv"},
      {"figures", dvh_figures(doses, colours)},
      {"oedema", oedema_section(outcome.oedema ? &*outcome.oedema : nullptr)},
      {"errors", error_table(history)},
      {"cause_meanings", cause_meanings(history)},
      {"causes_left_out", html_prose(causes_left_out(history))},
      {"needles", needle_table(history)},
      {"found", found_section(outcome)},
      {"choices", choices},
      {"dvh_of_found", found ? " Dotted lines are the dose of the seeds where they were found on imaging." : ""},
      {"marks_of_found", found ? " Crosses are the places where seeds were found on imaging." : ""},
      {"space_of_found", found ? " Orange marks are the places where seeds were found on imaging." : ""},
      {"space_of_needles",
       needles_together(history)
           ? fmt::format(" Shafts are those of {} that are in the tissue together, bent as they are "
                         "when the last of them has gone in.",
                         nouns_of(history).needles)
           : ""},
      {"report_of_found", found ? "; <a href=\"found/report.html\">the dose of the found seeds</a>" : ""},
      {"files_of_found", found ? " The match with the found seeds is in <code>found.csv</code>." : ""},
      {"seeds", seed_error_table(history)},
      {"procedure", procedure_facts(outcome.scenario, implant) + probe_definitions(outcome)},
      {"seed_facts", seed_facts(outcome.scenario, implant)},
      {"tissue", tissue_facts(outcome.scenario, history.nodes)},
      {"plan", plan_facts(outcome.planned)},
      {"assumptions", sentence_list(outcome.delivered.assumptions)},
      {"data", json_script_safe(dose_page_data(outcome.delivered, dvh.delivered, colours))},
      {"more_data", "<script type=\"application/json\" id=\"implant-data\">" +
                        json_script_safe(implant_page_data(outcome, dvh.planned, found)) + "</script>\n"},
  };
  add_kind_words(slots, implant);
  return page_about_dose(implant_assets(), slots);
}

}  // namespace stylet::results
