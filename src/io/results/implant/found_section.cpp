// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/found_section.hpp"

#include "fixed_number.hpp"
#include "implant/implant_tables.hpp"
#include "implant/implant_words.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::results {
namespace {

std::string tiles_of_found(const FoundImplant& found) {
  const FoundComparison& comparison = found.comparison;
  const SeedMatching& matching = comparison.matching;
  std::string html =
      figure_tile(fmt::format("{}<small>{} found, {} simulated</small>", matching.pairs.size(),
                              found.seeds.seeds.size(), matching.pairs.size() + matching.not_found.size()),
                  "matched seeds");
  if (comparison.seeds.empty()) return html;
  const auto millimetres = [](double mm) { return fixed(mm, 1) + "&nbsp;mm"; };
  html += figure_tile(millimetres(comparison.as_found.error.mean_mm), "mean error, found against planned") +
          figure_tile(millimetres(matching.shift_mm.norm()), "common shift against the simulation") +
          figure_tile(millimetres(comparison.without_shift.remainder.mean_mm),
                      "mean distance from the simulated place, without it");
  if (comparison.all.explained_percent) {
    html += figure_tile(fixed(std::max(0.0, *comparison.all.explained_percent), 0) + "&nbsp;%",
                        "of the variance explained by the simulation");
  }
  return html;
}

/// Which seeds match in one paragraph, shift and agreement in another.
std::string paragraphs_of(const ImplantHistory& history, const FoundImplant& found) {
  const std::vector<std::string> sentences = found_sentences(history, found);
  std::string html;
  for (std::size_t k = 0; k < sentences.size(); ++k)
    html += (k % 2 == 0 ? (k == 0 ? "<p>" : "</p><p>") : " ") + html_prose(sentences[k]);
  return html + "</p>";
}

std::string table_of_found_errors(const FoundComparison& comparison) {
  std::vector<SeedHistory> simulated;
  for (const MatchedSeed& matched : comparison.seeds) simulated.push_back(matched.seed);
  std::string head = text_heading("From … to");
  for (const char* name :
       {"Seeds", "Mean distance [mm]", "95 % within [mm]", "Left [mm]", "Posterior [mm]", "Superior [mm]"})
    head += figure_heading(name);
  return scrolled_table("scroll", "figures errors found-errors", head,
                        error_row("planned to simulated", seed_errors(simulated)) +
                            error_row("planned to found", comparison.as_found.error) +
                            error_row("planned to found, without common shift", comparison.without_shift.error) +
                            error_row("simulated to found", comparison.as_found.remainder) +
                            error_row("simulated to found, without common shift", comparison.without_shift.remainder));
}

std::string table_of_agreement(const FoundComparison& comparison) {
  std::string rows;
  const auto row = [&](const char* name, const Agreement& agreement) {
    rows += "<tr>" + text_cell(name) +
            figure_cell(agreement.correlation ? signed_number(*agreement.correlation, 2) : "–") +
            figure_cell(agreement.explained_percent ? signed_number(*agreement.explained_percent, 0) : "–") + "</tr>";
  };
  row("left", comparison.axes[0]);
  row("posterior", comparison.axes[1]);
  row("superior", comparison.axes[2]);
  row("all", comparison.all);
  return scrolled_table("scroll", "figures agreement",
                        text_heading("Axis") + figure_heading("Correlation") + figure_heading("Variance explained [%]"),
                        rows);
}

std::string three_lengths(const Vec3& v) {
  return figure_cell(
      fmt::format("{}, {}, {}", signed_number(v.x(), 1), signed_number(v.y(), 1), signed_number(v.z(), 1)));
}

std::string three_places(const Vec3& v) {
  return figure_cell(fmt::format("{}, {}, {}", fixed(v.x(), 1), fixed(v.y(), 1), fixed(v.z(), 1)));
}

std::string table_of_matches(const ImplantHistory& history, const FoundImplant& found) {
  const FoundComparison& comparison = found.comparison;
  std::string head = figure_heading("No.") + text_heading("Needle");
  for (const char* name : {"Planned [mm]", "Dropped [mm]", "At rest, simulated [mm]", "Found [mm]", "Found error [mm]",
                           "Simulated error [mm]", "Not explained [mm]"})
    head += figure_heading(name);
  head += text_heading("Remark");
  std::vector<const MatchedSeed*> match_of(history.seeds.size(), nullptr);
  for (std::size_t k = 0; k < comparison.seeds.size(); ++k)
    match_of[comparison.matching.pairs[k].dropped] = &comparison.seeds[k];
  const std::string dash = figure_cell("–");
  std::string rows;
  for (std::size_t k = 0; k < history.seeds.size(); ++k) {
    const SeedHistory& seed = history.seeds[k];
    const MatchedSeed* matched = match_of[k];
    rows += "<tr>" + figure_cell(fmt::format("{}", seed.number + 1)) + text_cell(history.needles[seed.needle].name) +
            three_places(seed.planned_mm) + three_places(seed.dropped_mm) +
            (seed.lost ? dash : three_places(seed.rest_mm)) + (matched ? three_places(matched->found_mm) : dash) +
            (matched ? three_lengths(matched->error_mm()) : dash) +
            (seed.lost ? dash : three_lengths(seed.error_mm())) +
            (matched ? three_lengths(matched->remainder_mm) : dash) +
            text_cell(seed.lost            ? "lost in the simulation"
                      : !matched           ? "not found"
                      : matched->ambiguous ? "ambiguous match"
                                           : "") +
            "</tr>";
  }
  for (const std::size_t k : comparison.matching.extra) {
    rows += "<tr>" + dash + text_cell("") + dash + dash + dash + three_places(found.seeds.seeds[k].at_mm) + dash +
            dash + dash + text_cell("matches no simulated seed") + "</tr>";
  }
  return fmt::format("<details><summary>All {} seeds and where they were found</summary>{}</details>",
                     history.seeds.size(), scrolled_table("scroll tall-table", "figures seeds-table", head, rows));
}

}  // namespace

std::string found_section(const ImplantOutcome& outcome) {
  if (!outcome.found) return {};
  const FoundImplant& found = *outcome.found;
  const FoundComparison& comparison = found.comparison;
  std::string html = fmt::format(
      "<section aria-labelledby=\"found\"><h2 id=\"found\">Found on imaging</h2><p>The seeds of <code>{}</code>, which "
      "were found on images after the implant, beside those of the simulation. Their places are taken as the file "
      "gives "
      "them, in the coordinates of the plan.</p><ul class=\"tiles\">{}</ul>{}",
      html_escaped(found.seeds.file), tiles_of_found(found), paragraphs_of(outcome.history, found));
  if (!comparison.seeds.empty()) {
    html +=
        table_of_found_errors(comparison) +
        "<h3>Does the simulation explain what was found?</h3><p>Each mark is a matched seed. On the solid line the "
        "error "
        "that was found is the simulated one; the dashed line is that line moved by the common shift, about which the "
        "seeds scatter. Open marks are ambiguous matches. All three pictures have the same scale.<span "
        "class=\"needs-script-inline\"> Point at a mark to see its seed and needle.</span></p><div "
        "class=\"needs-script\">"
        "<div class=\"legend third-key\" id=\"found-key\"></div><div class=\"scatters square\" "
        "id=\"found-charts\"></div></div>"
        "<h3>What the errors that were found are made of</h3><div class=\"why\"><div><div class=\"needs-script\" "
        "id=\"found-parts\"></div>" +
        chart_note("summary.json") +
        "</div><div><p>The error of a seed is the sum of its simulated parts, the common shift and what the simulation "
        "does not explain. The mean of the product of each part with the whole error is its part of the mean square; "
        "these parts add up to 100 %. A negative part points against the errors on average: without it they would be "
        "larger.</p><p>" +
        html_prose(fmt::format("The mean square of the errors is {} mm² as found and {} mm² without the common shift.",
                               fixed(comparison.as_found.mean_square_mm2, 2),
                               fixed(comparison.without_shift.mean_square_mm2, 2))) +
        "</p>" + table_of_agreement(comparison) + "</div></div>";
  }
  return html + table_of_matches(outcome.history, found) + "</section>";
}

}  // namespace stylet::results
