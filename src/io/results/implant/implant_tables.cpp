// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/implant_tables.hpp"

#include "dose/dose_text.hpp"
#include "dose/structure_look.hpp"
#include "fixed_number.hpp"
#include "implant/implant_words.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::results {
namespace {

std::string millimetres(double mm) { return fixed(mm, 1) + "&nbsp;mm"; }

std::string becomes(const std::string& planned, const std::string& delivered) {
  return planned + " <i aria-label=\"to\">→</i> " + delivered;
}

std::string target_tiles(const ImplantOutcome& outcome) {
  const StructureDose* planned = find_region(outcome.planned, "prostate");
  const StructureDose* delivered = find_region(outcome.delivered, "prostate");
  if (!planned || !delivered) return {};
  const double prescription = outcome.delivered.prescription_Gy;
  const double before = planned->dvh.dose_of_percent(90.0), after = delivered->dvh.dose_of_percent(90.0);
  std::string html = figure_tile(
      becomes(fixed(before, 0), fixed(after, 0) + "&nbsp;Gy"),
      prescription > 0.0 ? fmt::format("target D90, planned → delivered ({} → {} %)",
                                       fixed(100.0 * before / prescription, 0), fixed(100.0 * after / prescription, 0))
                         : "target D90, planned → delivered");
  if (prescription > 0.0) {
    html += figure_tile(becomes(fixed(planned->dvh.percent_above(prescription), 1),
                                percent(delivered->dvh.percent_above(prescription))),
                        "target V100, planned → delivered");
  }
  return html;
}

std::string place_cell(const Vec3& mm) {
  return figure_cell(fmt::format("{}, {}, {}", fixed(mm.x(), 1), fixed(mm.y(), 1), fixed(mm.z(), 1)));
}

std::string remark_on(const SeedHistory& seed) {
  if (seed.lost) return "lost";
  return seed.in_tissue
             ? ""
             : (seed.at_planning ? "no tissue was found where it is" : "no tissue was found where it was dropped");
}

}  // namespace

std::string implant_tiles(const ImplantOutcome& outcome) {
  const SeedErrors errors = seed_errors(outcome.history.seeds);
  const std::size_t lost = outcome.history.seeds.size() - errors.seeds;
  const bool temporary = implant_of(outcome.history.seeds) == Implant::temporary;
  const ImplantNouns& nouns = nouns_of(outcome.history);
  return figure_tile(millimetres(errors.mean_mm), fmt::format("mean error of the {}", nouns.sources)) +
         figure_tile(millimetres(errors.p95_mm), fmt::format("95 % of the {} within", nouns.sources)) +
         target_tiles(outcome) +
         figure_tile(temporary ? fmt::format("{}", outcome.history.seeds.size())
                               : fmt::format("{}<small>{} lost</small>", outcome.history.seeds.size(), lost),
                     nouns.sources) +
         figure_tile(fmt::format("{}", outcome.history.needles.size()), nouns.needles);
}

std::string error_row(const std::string& name, const SeedErrors& errors) {
  std::string cells = text_cell(name) + figure_cell(fmt::format("{}", errors.seeds));
  for (const double mm : {errors.mean_mm, errors.p95_mm}) cells += figure_cell(errors.seeds > 0 ? fixed(mm, 2) : "–");
  for (const SeedErrors::Axis& axis : errors.axes)
    cells += figure_cell(errors.seeds > 0 ? signed_number(axis.mean_mm, 2) + " ± " + fixed(axis.sd_mm, 2) : "–");
  return "<tr>" + cells + "</tr>";
}

std::string error_table(const ImplantHistory& history) {
  const ImplantNouns& nouns = nouns_of(history);
  std::string rows = error_row(fmt::format("all {}", nouns.sources), seed_errors(history.seeds));
  for (const PartErrors& third : errors_by_third(history)) rows += error_row(third.name, third.errors);
  std::string head = text_heading("Part of the gland") + figure_heading(capital(nouns.sources));
  for (const char* name : {"Mean distance [mm]", "95 % within [mm]", "Left [mm]", "Posterior [mm]", "Superior [mm]"})
    head += figure_heading(name);
  return scrolled_table("scroll", "figures errors", head, rows);
}

std::string cause_meanings(const ImplantHistory& history) {
  std::string html;
  for (const CauseOfErrors& cause : causes_that_moved(history)) {
    html += fmt::format("<dt>{}</dt><dd>{} {}</dd>", to_string(cause.cause),
                        meaning_of(cause.cause, implant_of(history.seeds)),
                        html_prose(fmt::format("Its mean size is {} mm.", fixed(cause.mean_mm, 2))));
  }
  return html;
}

std::string needle_table(const ImplantHistory& history) {
  const std::vector<PartErrors> errors = errors_by_needle(history);
  const ImplantNouns& nouns = nouns_of(history);
  std::string head =
      figure_heading("Order") + text_heading(capital(nouns.needle)) + figure_heading(capital(nouns.sources));
  for (const char* name :
       {"Mean error [mm]", "Largest gland shift [mm]", "Peak force [N]", "Deflection [mm]", "Depth [mm]"})
    head += figure_heading(name);
  std::string rows;
  for (std::size_t k = 0; k < history.needles.size(); ++k) {
    const NeedleHistory& needle = history.needles[k];
    const SeedErrors& of_needle = errors[k].errors;
    const double shift = needle.gland_shift_mm.norm();
    rows += "<tr>" + figure_cell(fmt::format("{}", k + 1)) + text_cell(needle.name) +
            figure_cell(fmt::format("{}", of_needle.seeds)) +
            figure_cell(of_needle.seeds > 0 ? fixed(of_needle.mean_mm, 2) : "–") +
            figure_cell(std::isfinite(shift) ? fixed(shift, 2) : "–") + figure_cell(fixed(needle.peak_force_N, 2)) +
            figure_cell(fixed(needle.deflection_mm, 2)) + figure_cell(fixed(needle.depth_mm, 1)) + "</tr>";
  }
  return scrolled_table("scroll", "figures", head, rows);
}

std::string seed_error_table(const ImplantHistory& history) {
  const std::vector<CauseOfErrors> causes = causes_that_moved(history);
  const bool remarks = std::any_of(history.seeds.begin(), history.seeds.end(),
                                   [](const SeedHistory& seed) { return !remark_on(seed).empty(); });
  const ImplantNouns& nouns = nouns_of(history);
  const bool temporary = implant_of(history.seeds) == Implant::temporary;
  std::string head = figure_heading("No.") + text_heading(capital(nouns.needle)) + figure_heading("Planned [mm]");
  if (temporary) head += figure_heading("Tissue at planning [mm]");
  head += figure_heading(temporary ? "In the room at delivery [mm]" : "Dropped [mm]") +
          figure_heading(temporary ? "Tissue at delivery [mm]" : "At rest [mm]") + figure_heading("Error [mm]");
  for (const CauseOfErrors& cause : causes) head += figure_heading(fmt::format("by {} [mm]", to_string(cause.cause)));
  if (remarks) head += text_heading("Remark");
  std::string rows;
  for (const SeedHistory& seed : history.seeds) {
    rows += "<tr>" + figure_cell(fmt::format("{}", seed.number + 1)) + text_cell(history.needles[seed.needle].name) +
            place_cell(seed.planned_mm) + (seed.at_planning ? place_cell(seed.at_planning->tissue_mm) : "") +
            place_cell(seed.dropped_mm) +
            (seed.lost ? figure_cell("–") + figure_cell("–")
                       : place_cell(seed.rest_mm) + figure_cell(fixed(seed.error_mm().norm(), 2)));
    for (const CauseOfErrors& cause : causes)
      rows += figure_cell(seed.lost ? "–" : fixed(seed.by(cause.cause).norm(), 2));
    if (remarks) rows += text_cell(remark_on(seed));
    rows += "</tr>";
  }
  return fmt::format("<details><summary>All {} {}</summary>{}</details>", history.seeds.size(), nouns.sources,
                     scrolled_table("scroll tall-table", "figures seeds-table", head, rows));
}

}  // namespace stylet::results
