// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/page_tables.hpp"

#include "dose/dose_text.hpp"
#include "dose/goal_text.hpp"
#include "dose/structure_look.hpp"
#include "fixed_number.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

namespace stylet::results {
namespace {

/// A dose, with its share of the prescribed dose where there is one, as HTML.
std::string gray_of(double dose_Gy, double prescription_Gy) {
  return gray(dose_Gy) + small_share(dose_Gy, prescription_Gy);
}

std::string source_tiles(const DosePlan& plan) {
  double strength = 0.0, time = 0.0;
  for (const PlannedSource& source : plan.sources) {
    strength += source.strength_U;
    time += source.dwell_s;
  }
  if (plan.implant == Implant::permanent) {
    return figure_tile(fmt::format("{}", plan.sources.size()), "seeds") +
           figure_tile(fixed(strength, 2) + "&nbsp;U", "total air-kerma strength");
  }
  return figure_tile(fmt::format("{}", plan.sources.size()), "dwell positions") +
         figure_tile(fixed(time, 1) + "&nbsp;s", "total dwell time");
}

/// The region that a structure is taken as, unless its name says it.
std::string taken_as(const StructureDose& structure) {
  const std::string region = structure.region == "prostate" ? "target" : structure.region;
  const std::array<std::string, 1> names{structure.name};
  if (region.empty() || !find_named(names, region).empty()) return {};
  return " <span class=\"taken\">" + html_escaped(region) + "</span>";
}

std::string formalism_text(DoseFormalism formalism) {
  switch (formalism) {
    case DoseFormalism::line2d:
      return "TG-43U1, line source, two-dimensional anisotropy";
    case DoseFormalism::line1d:
      return "TG-43U1, line source, one-dimensional anisotropy: the seeds’ directions do not count";
    case DoseFormalism::point:
      return "TG-43U1, point source: the seeds’ directions do not count";
  }
  return {};
}

}  // namespace

std::string dose_tiles(const DoseEvaluation& evaluation) {
  const double prescription = evaluation.prescription_Gy;
  std::string html;
  if (const StructureDose* target = find_region(evaluation, "prostate")) {
    html += figure_tile(gray_of(target->dvh.dose_of_percent(90.0), prescription), "target D90");
    if (prescription > 0.0) {
      html += figure_tile(percent(target->dvh.percent_above(prescription)), "target V100") +
              figure_tile(percent(target->dvh.percent_above(1.5 * prescription)), "target V150");
    }
  }
  if (const StructureDose* urethra = find_region(evaluation, "urethra")) {
    html += figure_tile(gray_of(urethra->dvh.dose_of_percent(10.0), prescription), "urethra D10") +
            figure_tile(gray_of(urethra->dvh.dose_of_percent(30.0), prescription), "urethra D30");
  }
  if (const StructureDose* rectum = find_region(evaluation, "rectum"))
    html += figure_tile(gray_of(rectum->dvh.dose_of_volume(2.0), prescription), "rectum D2cc");
  return html + source_tiles(evaluation.plan);
}

std::string goal_table(const std::vector<NamedDose>& doses) {
  const std::vector<JudgedGoal>& goals = doses.front().evaluation->goals;
  if (goals.empty()) return "<p>No goals were given, so the plan was not judged.</p>";
  std::string head = text_heading("Structure") + text_heading("Figure") + figure_heading("Goal");
  for (const NamedDose& dose : doses) head += figure_heading(dose.name) + text_heading("Verdict");
  std::string rows;
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const DoseGoal& goal = goals[k].goal;
    rows += "<tr>" + text_cell(goal.structure) + text_cell(figure_name(goal)) +
            figure_cell(with_figure_unit(fmt::format("{} {:g}", goal.at_least ? "≥" : "≤", goal.bound), goal));
    for (const NamedDose& dose : doses) {
      const JudgedGoal& judged = dose.evaluation->goals[k];
      rows += figure_cell(reached_text(judged)) + "<td>" + verdict_badge(judged) + "</td>";
    }
    rows += "<td class=\"source\">" + html_escaped(goal.citation) + "</td></tr>";
  }
  return scrolled_table("scroll", "goals", head + text_heading("From"), rows);
}

namespace {

/// The figures of one structure's histogram, as cells.
std::string figures_of(const StructureDose& structure, double prescription_Gy, bool with_grid) {
  const DoseVolume& dvh = structure.dvh;
  std::string cells = figure_cell(fixed(dvh.volume_cc(), 2));
  for (const double dose : {dvh.dose_of_percent(90.0), dvh.dose_of_percent(30.0), dvh.dose_of_percent(10.0),
                            dvh.dose_of_volume(2.0), dvh.dose_of_volume(0.1), dvh.mean_Gy()})
    cells += figure_cell(fixed(dose, 1));
  if (prescription_Gy > 0.0) {
    for (const double times : {1.0, 1.5, 2.0})
      cells += figure_cell(fixed(dvh.percent_above(times * prescription_Gy), 1));
  }
  return with_grid ? cells + figure_cell(fixed(structure.covered_by_grid_percent, 0)) : cells;
}

/// Why some figures are "–"; nothing where none is.
std::string reasons_of_dashes(const DoseEvaluation& evaluation) {
  const std::vector<std::string> reasons = figures_left_out(evaluation.structures);
  return reasons.empty() ? std::string() : "<ul class=\"reasons\">" + sentence_list(reasons) + "</ul>";
}

/// Pass rates of the gamma index, with what they are of.
std::string gamma_text(const GammaRates& gamma, double prescription_Gy) {
  const GammaCriteria& by = gamma.criteria;
  return fmt::format(
      "<h4>Gamma index, {:g} % and {:g} mm</h4><p>{} % of the points pass with {:g} % of the dose at the point "
      "(local), {} % with {:g} % of {:g} Gy, {} (global): {} of the points above, those with at least {:g} % of "
      "{:g} Gy. The file is the reference (Low et al., Med Phys 25:656, 1998). The dose is computed anew at steps of "
      "{:g} mm along 100 directions, linearly in between.</p>",
      by.dose_percent, by.distance_mm, fixed(gamma.local_percent, 1), by.dose_percent, fixed(gamma.global_percent, 1),
      by.dose_percent, gamma.global_Gy,
      prescription_Gy > 0.0 ? "the prescribed dose" : "the largest dose that is compared", gamma.points,
      by.threshold_percent, gamma.global_Gy, by.distance_mm / 5.0);
}

}  // namespace

std::string dvh_figures(const std::vector<NamedDose>& doses, const std::vector<std::string>& colours) {
  const DoseEvaluation& first = *doses.front().evaluation;
  if (first.structures.empty()) return "<p>No structures were given.</p>";
  std::string head = text_heading("Structure");
  if (doses.size() > 1) head += text_heading("Dose");
  for (const char* name : {"Volume [cc]", "D90 [Gy]", "D30 [Gy]", "D10 [Gy]", "D2cc [Gy]", "D0.1cc [Gy]", "Mean [Gy]"})
    head += figure_heading(name);
  if (first.prescription_Gy > 0.0) {
    for (const char* name : {"V100 [%]", "V150 [%]", "V200 [%]"}) head += figure_heading(name);
  }
  const bool alone = doses.size() == 1;  // reports of one dose say how much of a structure its grid holds
  if (alone) head += figure_heading("In the dose grid [%]");
  std::string rows;
  for (std::size_t k = 0; k < first.structures.size(); ++k) {
    rows += fmt::format("<tr><td{}><span class=\"swatch\" style=\"background:{}\"></span> {}{}</td>",
                        doses.size() > 1 ? fmt::format(" rowspan=\"{}\"", doses.size()) : "", colours[k],
                        html_escaped(first.structures[k].name), taken_as(first.structures[k]));
    for (const NamedDose& dose : doses) {
      if (&dose != &doses.front()) rows += "<tr>";
      if (doses.size() > 1) rows += text_cell(dose.name);
      rows += figures_of(dose.evaluation->structures[k], first.prescription_Gy, alone) + "</tr>";
    }
  }
  return scrolled_table("scroll", "figures", head, rows) + reasons_of_dashes(first);
}

std::string points_and_comparison(const DoseEvaluation& evaluation) {
  std::string html;
  if (const auto& compared = evaluation.comparison) {
    html += fmt::format(
        "<h3>Compared with {}</h3><p>At {} points of this grid, more than 4 mm from each source, the computed dose is "
        "{:.3f} times the dose of the file in the median; the ratio lies between {:.3f} and {:.3f} at 98 % of the "
        "points.</p>",
        html_escaped(std::filesystem::path(compared->file).filename().string()), compared->points,
        compared->median_ratio, compared->p1, compared->p99);
    if (compared->gamma) html += gamma_text(*compared->gamma, evaluation.prescription_Gy);
    if (!compared->difference.dose_Gy.empty()) {
      html +=
          "<div class=\"needs-script\"><h4>Computed dose minus the dose of the file</h4><div class=\"iso-key\" "
          "id=\"difference-key\"></div><div class=\"sections\" id=\"difference-pictures\"></div></div>";
    }
  }
  if (evaluation.points.empty()) return html;
  std::string rows;
  for (std::size_t k = 0; k < evaluation.points.size() && k < evaluation.point_Gy.size(); ++k) {
    const Vec3& x = evaluation.points[k];
    rows += "<tr>" + figure_cell(fixed(x.x(), 2)) + figure_cell(fixed(x.y(), 2)) + figure_cell(fixed(x.z(), 2)) +
            figure_cell(fixed(evaluation.point_Gy[k], 3)) + "</tr>";
  }
  return html + "<h3>Dose at points</h3>" +
         scrolled_table("scroll tall-table", "figures",
                        figure_heading("x [mm]") + figure_heading("y [mm]") + figure_heading("z [mm]") +
                            figure_heading("Dose [Gy]"),
                        rows);
}

std::string seed_table(const DoseEvaluation& evaluation) {
  const bool temporary = evaluation.plan.implant == Implant::temporary;
  std::string rows;
  std::size_t number = 0;
  for (const PlannedSource& source : evaluation.plan.sources) {
    rows += "<tr>" + figure_cell(fmt::format("{}", ++number)) + text_cell(source.needle);
    for (int k = 0; k < 3; ++k) rows += figure_cell(fixed(source.at_mm[k], 2));
    rows +=
        text_cell(with_minus_signs(fmt::format("({}, {}, {}){}", fixed(source.axis.x(), 3), fixed(source.axis.y(), 3),
                                               fixed(source.axis.z(), 3), source.has_axis ? "" : ", assumed")));
    rows += figure_cell(fixed(source.strength_U, 4));
    if (temporary) rows += figure_cell(fixed(source.dwell_s, 2));
    rows += "</tr>";
  }
  return fmt::format(
      "<details><summary>All {} {}</summary><div class=\"scroll tall-table\"><table class=\"figures\"><thead><tr><th "
      "class=\"number\">No.</th><th>Needle</th><th class=\"number\">x [mm]</th><th class=\"number\">y [mm]</th><th "
      "class=\"number\">z [mm]</th><th>Axis</th><th class=\"number\">Strength [U]</th>{}</tr></thead><tbody>{}</tbody>"
      "</table></div></details>",
      evaluation.plan.sources.size(), temporary ? "dwell positions" : "seeds",
      temporary ? "<th class=\"number\">Time [s]</th>" : "", rows);
}

std::string plan_facts(const DoseEvaluation& evaluation) {
  const DosePlan& plan = evaluation.plan;
  const SourceModel& source = evaluation.source;
  const bool known = evaluation.prescription_Gy > 0.0;
  return definition("Plan", std::filesystem::path(plan.file).filename().string()) + definition("Label", plan.label) +
         definition("Implant", plan.implant == Implant::permanent ? "permanent" : "temporary") +
         definition("Prescribed dose", known ? fmt::format("{:g} Gy", evaluation.prescription_Gy) : "none is known") +
         definition("Dose shown", evaluation.quantity) + definition("Date of the strength", plan.strength_date) +
         definition("Source",
                    fmt::format("{} ({}), half-life {:g} d", source.title, source.isotope, source.half_life_days)) +
         definition("Data of the source", source.citation) +
         definition("Dose rate constant", fmt::format("{:g} cGy/(h U)", source.dose_rate_constant)) +
         definition("Formalism", formalism_text(evaluation.formalism)) +
         definition("Frame of reference", plan.frame_of_reference);
}

}  // namespace stylet::results
