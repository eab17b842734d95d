// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/implant_page.hpp"

#include "dose/dose_text.hpp"
#include "dose/dvh_picture.hpp"
#include "dose/dvh_table.hpp"
#include "dose/page_data.hpp"
#include "dose/page_shell.hpp"
#include "dose/page_tables.hpp"
#include "dose/structure_look.hpp"
#include "implant/cause_picture.hpp"
#include "implant/error_pictures.hpp"
#include "implant/implant_data.hpp"
#include "implant/implant_tables.hpp"
#include "implant/implant_words.hpp"
#include "implant/procedure_facts.hpp"
#include "report/assets.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"

namespace stylet::results {
namespace {

/// Both histograms at the same doses, which reach as far as the hotter of them does.
struct BothDvh {
  DvhTable planned, delivered;
};

BothDvh both_dvh(const ImplantOutcome& outcome) {
  const DvhTable planned = dvh_table(outcome.planned), delivered = dvh_table(outcome.delivered);
  const std::vector<double>& dose_Gy =
      planned.dose_Gy.back() > delivered.dose_Gy.back() ? planned.dose_Gy : delivered.dose_Gy;
  return {.planned = dvh_at(outcome.planned, dose_Gy), .delivered = dvh_at(outcome.delivered, dose_Gy)};
}

}  // namespace

Result<std::string> implant_page(const ImplantOutcome& outcome) {
  const ImplantHistory& history = outcome.history;
  const std::vector<NamedDose> doses{{"Planned", &outcome.planned}, {"Delivered", &outcome.delivered}};
  const std::vector<std::string> colours = structure_colours(outcome.delivered.structures);
  const BothDvh dvh = both_dvh(outcome);
  const Slots slots{
      {"report", "implant report"},
      {"kicker", "Simulation of a seed implant"},
      {"kind", "simulation"},
      {"title", html_escaped(outcome.scenario.name)},
      {"facts", html_prose(plan_line(outcome.planned))},
      {"css", std::string(implant_css())},
      {"warnings", box_of_warnings(outcome.warnings)},
      {"tiles", implant_tiles(outcome)},
      {"story", implant_story(outcome)},
      {"goals", goal_table(doses)},
      {"dvh_picture", dvh_picture(outcome.delivered.structures, dvh.delivered, colours, &dvh.planned)},
      {"figures", dvh_figures(doses, colours)},
      {"errors", error_table(history)},
      {"cause_picture", cause_picture(history)},
      {"cause_meanings", cause_meanings(history)},
      {"causes_left_out", html_prose(causes_left_out(history))},
      {"third_key", third_key(history)},
      {"error_pictures", error_pictures(history)},
      {"needles", needle_table(history)},
      {"seeds", seed_error_table(history)},
      {"procedure", procedure_facts(outcome.scenario)},
      {"seed_facts", seed_facts(outcome.scenario)},
      {"tissue", tissue_facts(outcome.scenario, history.nodes)},
      {"plan", plan_facts(outcome.planned)},
      {"assumptions", sentence_list(outcome.delivered.assumptions)},
      {"data", json_script_safe(dose_page_data(outcome.delivered, dvh.delivered, colours))},
      {"more_data", "<script type=\"application/json\" id=\"implant-data\">" +
                        json_script_safe(implant_page_data(history, dvh.planned)) + "</script>\n"},
      {"js", script_safe(implant_js())},
  };
  return page_about_dose(implant_template(), slots);
}

}  // namespace stylet::results
