// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/page_tables.hpp"

#include "dose/goal_text.hpp"
#include "dose/structure_look.hpp"
#include "fixed_number.hpp"
#include "report/text.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace stylet::results {
namespace {

std::string text_cell(const std::string& text) { return "<td>" + html_escaped(text) + "</td>"; }
std::string figure_cell(const std::string& text) { return "<td class=\"number\">" + html_escaped(text) + "</td>"; }

/// @param value HTML
std::string figure_tile(const std::string& value, const std::string& caption) {
  return "<li><b>" + value + "</b><span>" + html_escaped(caption) + "</span></li>";
}

/// A dose with one decimal below 100 Gy.
std::string gray(double dose_Gy) { return fixed(dose_Gy, std::abs(dose_Gy) < 99.95 ? 1 : 0) + "&nbsp;Gy"; }

std::string percent(double value) { return fixed(value, 1) + "&nbsp;%"; }

/// A dose, with its share of the prescribed dose where there is one, as HTML.
std::string gray_of(double dose_Gy, double prescription_Gy) {
  if (prescription_Gy <= 0.0) return gray(dose_Gy);
  return gray(dose_Gy) + "<small>" + fixed(100.0 * dose_Gy / prescription_Gy, 0) + "&nbsp;%</small>";
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
  return figure_tile(fmt::format("{}", plan.sources.size()), "dwell places") +
         figure_tile(fixed(time, 1) + "&nbsp;s", "total dwell time");
}

/// The verdict as word, sign and colour, each of which is sufficient by itself.
std::string verdict_badge(const JudgedGoal& judged) {
  const auto make = [](const char* style, const char* sign, const char* word) {
    return fmt::format("<span class=\"verdict {}\"><i>{}</i>{}</span>", style, sign, word);
  };
  if (!judged.value) return make("skipped", "–", "not judged");
  return judged.met ? make("pass", "✓", "met") : make("missed", "✗", "missed");
}

std::string with_figure_unit(const std::string& value, const DoseGoal& goal) {
  const std::string unit = figure_unit(goal);
  return unit.empty() ? value : value + " " + unit;
}

std::string definition(const std::string& name, const std::string& value) {
  return value.empty() ? std::string() : "<dt>" + html_escaped(name) + "</dt><dd>" + html_prose(value) + "</dd>";
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

std::string goal_table(const DoseEvaluation& evaluation) {
  if (evaluation.goals.empty()) return "<p>No goals were given, so the plan was not judged.</p>";
  std::string rows;
  for (const JudgedGoal& judged : evaluation.goals) {
    const DoseGoal& goal = judged.goal;
    rows +=
        "<tr>" + text_cell(goal.structure) + text_cell(figure_name(goal)) +
        figure_cell(with_figure_unit(fmt::format("{} {:g}", goal.at_least ? "≥" : "≤", goal.bound), goal)) +
        figure_cell(judged.value ? with_figure_unit(fixed(*judged.value, goal.metric.ends_with("_cc") ? 2 : 1), goal)
                                 : "–") +
        "<td>" + verdict_badge(judged) + "</td><td class=\"source\">" + html_escaped(goal.citation) + "</td></tr>";
  }
  return "<div class=\"scroll\"><table class=\"goals\"><thead><tr><th>Structure</th><th>Figure</th><th "
         "class=\"number\">Goal</th><th class=\"number\">Plan</th><th>Verdict</th><th>From</th></tr></thead><tbody>" +
         rows + "</tbody></table></div>";
}

std::string dvh_figures(const DoseEvaluation& evaluation, const std::vector<std::string>& colours) {
  if (evaluation.structures.empty()) return "<p>No structures were given.</p>";
  const double prescription = evaluation.prescription_Gy;
  std::string head =
      "<th>Structure</th><th class=\"number\">Volume [cc]</th><th class=\"number\">D90 [Gy]</th><th "
      "class=\"number\">D30 [Gy]</th><th class=\"number\">D10 [Gy]</th><th class=\"number\">D2cc [Gy]</th><th "
      "class=\"number\">D0.1cc [Gy]</th><th class=\"number\">Mean [Gy]</th>";
  if (prescription > 0.0) {
    for (const char* name : {"V100", "V150", "V200"}) head += fmt::format("<th class=\"number\">{} [%]</th>", name);
  }
  head += "<th class=\"number\">In the dose grid [%]</th>";
  std::string rows;
  for (std::size_t k = 0; k < evaluation.structures.size(); ++k) {
    const StructureDose& s = evaluation.structures[k];
    const DoseVolume& dvh = s.dvh;
    rows += fmt::format("<tr><td><span class=\"swatch\" style=\"background:{}\"></span> {}{}</td>", colours[k],
                        html_escaped(s.name), taken_as(s));
    rows += figure_cell(fixed(dvh.volume_cc(), 2));
    for (const double dose : {dvh.dose_of_percent(90.0), dvh.dose_of_percent(30.0), dvh.dose_of_percent(10.0),
                              dvh.dose_of_volume(2.0), dvh.dose_of_volume(0.1), dvh.mean_Gy()})
      rows += figure_cell(fixed(dose, 1));
    if (prescription > 0.0) {
      for (const double times : {1.0, 1.5, 2.0}) rows += figure_cell(fixed(dvh.percent_above(times * prescription), 1));
    }
    rows += figure_cell(fixed(s.covered_by_grid_percent, 0)) + "</tr>";
  }
  return "<div class=\"scroll\"><table class=\"figures\"><thead><tr>" + head + "</tr></thead><tbody>" + rows +
         "</tbody></table></div>";
}

std::string points_and_comparison(const DoseEvaluation& evaluation) {
  std::string html;
  if (const auto& compared = evaluation.comparison) {
    html += fmt::format(
        "<h3>Compared with {}</h3><p>At {} points of this grid the computed dose is {:.3f} times the dose of the file "
        "in "
        "the median; the ratio lies between {:.3f} and {:.3f} at 98 % of the points.</p>",
        html_escaped(compared->file), compared->points, compared->median_ratio, compared->p1, compared->p99);
  }
  if (evaluation.points.empty()) return html;
  std::string rows;
  for (std::size_t k = 0; k < evaluation.points.size() && k < evaluation.point_Gy.size(); ++k) {
    const Vec3& x = evaluation.points[k];
    rows += "<tr>" + figure_cell(fixed(x.x(), 2)) + figure_cell(fixed(x.y(), 2)) + figure_cell(fixed(x.z(), 2)) +
            figure_cell(fixed(evaluation.point_Gy[k], 3)) + "</tr>";
  }
  return html +
         "<h3>Dose at points</h3><div class=\"scroll tall-table\"><table class=\"figures\"><thead><tr><th "
         "class=\"number\">x [mm]</th><th class=\"number\">y [mm]</th><th class=\"number\">z [mm]</th><th "
         "class=\"number\">Dose [Gy]</th></tr></thead><tbody>" +
         rows + "</tbody></table></div>";
}

std::string seed_table(const DoseEvaluation& evaluation) {
  const bool temporary = evaluation.plan.implant == Implant::temporary;
  std::string rows;
  std::size_t number = 0;
  for (const PlannedSource& source : evaluation.plan.sources) {
    rows += "<tr>" + figure_cell(fmt::format("{}", ++number)) + text_cell(source.needle);
    for (int k = 0; k < 3; ++k) rows += figure_cell(fixed(source.at_mm[k], 2));
    rows += text_cell(fmt::format("({:.3f}, {:.3f}, {:.3f}){}", source.axis.x(), source.axis.y(), source.axis.z(),
                                  source.has_axis ? "" : ", assumed"));
    rows += figure_cell(fixed(source.strength_U, 4));
    if (temporary) rows += figure_cell(fixed(source.dwell_s, 2));
    rows += "</tr>";
  }
  return fmt::format(
      "<details><summary>All {} {}</summary><div class=\"scroll tall-table\"><table class=\"figures\"><thead><tr><th "
      "class=\"number\">No.</th><th>Needle</th><th class=\"number\">x [mm]</th><th class=\"number\">y [mm]</th><th "
      "class=\"number\">z [mm]</th><th>Axis</th><th class=\"number\">Strength [U]</th>{}</tr></thead><tbody>{}</tbody>"
      "</table></div></details>",
      evaluation.plan.sources.size(), temporary ? "dwell places" : "seeds",
      temporary ? "<th class=\"number\">Time [s]</th>" : "", rows);
}

std::string plan_facts(const DoseEvaluation& evaluation) {
  const DosePlan& plan = evaluation.plan;
  const SourceModel& source = evaluation.source;
  const bool known = evaluation.prescription_Gy > 0.0;
  return definition("Plan", plan.file) + definition("Label", plan.label) +
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
