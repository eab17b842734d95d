// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/dose_page.hpp"

#include "dose/dvh_picture.hpp"
#include "dose/dvh_table.hpp"
#include "dose/page_data.hpp"
#include "dose/page_tables.hpp"
#include "dose/structure_look.hpp"
#include "report/assets.hpp"
#include "report/page_template.hpp"
#include "report/text.hpp"
#include "stylet/core/version.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace stylet::results {
namespace {

std::string sentence_list(const std::vector<std::string>& sentences) {
  std::string html;
  for (const std::string& sentence : sentences) html += "<li>" + html_prose(sentence) + "</li>";
  return html;
}

std::string box_of_warnings(const std::vector<std::string>& warnings) {
  return warnings.empty() ? std::string() : "<ul class=\"warnings\">" + sentence_list(warnings) + "</ul>";
}

std::string title_of(const DosePlan& plan) {
  if (!plan.label.empty()) return plan.label;
  const std::string name = std::filesystem::path(plan.file).filename().string();
  return name.empty() ? "Brachytherapy plan" : name;
}

std::string facts_of(const DoseEvaluation& evaluation) {
  const DosePlan& plan = evaluation.plan;
  const bool permanent = plan.implant == Implant::permanent;
  std::string facts = fmt::format("{} implant, {} {}, {}", permanent ? "permanent" : "temporary", plan.sources.size(),
                                  permanent ? "seeds" : "dwell places", evaluation.source.title);
  if (evaluation.prescription_Gy > 0.0) facts += fmt::format(", {:g} Gy prescribed", evaluation.prescription_Gy);
  const std::string name = std::filesystem::path(plan.file).filename().string();
  return name.empty() || plan.label.empty() ? facts : name + ": " + facts;
}

}  // namespace

Result<std::string> dose_page(const DoseEvaluation& evaluation) {
  const std::vector<std::string> colours = structure_colours(evaluation.structures);
  const DvhTable dvh = dvh_table(evaluation);
  const Slots slots{
      {"version", html_escaped(version())},
      {"title", html_escaped(title_of(evaluation.plan))},
      {"facts", html_prose(facts_of(evaluation))},
      {"css", std::string(dose_css())},
      {"warnings", box_of_warnings(evaluation.warnings)},
      {"tiles", dose_tiles(evaluation)},
      {"goals", goal_table(evaluation)},
      {"dvh_picture", dvh_picture(evaluation, dvh, colours)},
      {"figures", dvh_figures(evaluation, colours)},
      {"points", points_and_comparison(evaluation)},
      {"seeds", seed_table(evaluation)},
      {"plan", plan_facts(evaluation)},
      {"assumptions", sentence_list(evaluation.assumptions)},
      {"notes", evaluation.plan.notes.empty() ? std::string()
                                              : "<h3>What the reader of the plan decided</h3><ul>" +
                                                    sentence_list(evaluation.plan.notes) + "</ul>"},
      {"versions", html_escaped(fmt::format("Stylet {}", version()))},
      {"data", json_script_safe(dose_page_data(evaluation, dvh, colours))},
      {"js", script_safe(dose_js())},
  };
  return fill_page(dose_template(), slots, "report.html");
}

}  // namespace stylet::results
