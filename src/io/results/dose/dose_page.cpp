// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/dose_page.hpp"

#include "dose/dose_text.hpp"
#include "dose/dvh_table.hpp"
#include "dose/page_data.hpp"
#include "dose/page_record.hpp"
#include "dose/page_shell.hpp"
#include "dose/page_tables.hpp"
#include "dose/structure_look.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"

namespace stylet::results {

Result<std::string> dose_page(const DoseEvaluation& evaluation) {
  const std::vector<std::string> colours = structure_colours(evaluation.structures);
  const DvhTable dvh = dvh_table(evaluation);
  const Slots slots{
      {"kicker", "Dose of a brachytherapy plan"},
      {"kind", "computation"},
      {"title", html_escaped(plan_name(evaluation.plan)) + " – dose report"},
      {"heading", html_escaped(plan_name(evaluation.plan))},
      {"facts", html_prose(plan_line(evaluation))},
      {"more_css", printed_margins(evaluation)},
      {"record", record_of(evaluation)},
      {"warnings", box_of_warnings(evaluation.warnings)},
      {"tiles", dose_tiles(evaluation)},
      {"goals", goal_table({{"Plan", &evaluation}})},
      {"dvh_file", "dvh.csv"},
      {"figures", dvh_figures({{"Plan", &evaluation}}, colours)},
      {"points", points_and_comparison(evaluation)},
      {"seeds", seed_table(evaluation)},
      {"plan", plan_facts(evaluation)},
      {"assumptions", sentence_list(evaluation.assumptions)},
      {"notes", evaluation.plan.notes.empty() ? std::string()
                                              : "<h3>What the reader of the plan decided</h3><ul>" +
                                                    sentence_list(evaluation.plan.notes) + "</ul>"},
      {"data", json_script_safe(dose_page_data(evaluation, dvh, colours))},
  };
  return page_about_dose(dose_assets(), slots);
}

}  // namespace stylet::results
