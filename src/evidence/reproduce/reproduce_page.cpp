// SPDX-License-Identifier: GPL-3.0-or-later
#include "figure6_text.hpp"
#include "page_text.hpp"
#include "report/page_template.hpp"
#include "report/text.hpp"
#include "reproduction_data.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/evidence/reproduce/paper_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::reproduce {

using results::html_escaped;

namespace {

namespace stated = paper_numbers;

std::string tile(const std::string& value, const std::string& caption) {
  return "<li><b>" + html_escaped(value) + "</b><span>" + html_escaped(caption) + "</span></li>";
}

std::string tiles(const Reproduction& r) {
  const Figure6Run& bcs = r.figure6.run("bcs_repositioning");
  const Figure6Run& woodbury = r.figure6.run("woodbury_addition");
  const Figure6Run& ours = r.figure6.run("default");
  return tile(fmt::format("{} nodes", r.figure6.nodes),
              fmt::format("{} tetrahedra; the paper: {} and {}", r.figure6.tets, stated::kNodes, stated::kTets)) +
         tile(duration(bcs.worst_s(true)),
              fmt::format("worst iteration that changes the mesh, by switches; the paper: {}",
                          duration(stated::kWorstBcs_s))) +
         tile(duration(woodbury.worst_s(true)),
              fmt::format("worst iteration that changes the mesh, by Woodbury; the paper: iterations of less than {:g} "
                          "ms",
                          1e3 * stated::kWoodburyBelow_s)) +
         tile(duration(ours.worst_s(true)), "worst iteration that changes the mesh, by the default") +
         tile(duration(r.inside.ours.median_s), "median time of one change of the mesh alone, by the default") +
         tile(digits(r.inside.woodbury.median_s / r.inside.ours.median_s) + " ×",
              "time of the same change by Woodbury, relative to the default");
}

std::string figure5_caption(const Reproduction& r) {
  if (r.figure5.empty()) return {};
  const Figure5Row& first = r.figure5.front();
  const Figure5Row& last = r.figure5.back();
  const bool ordered = std::all_of(r.figure5.begin(), r.figure5.end(), [](const Figure5Row& row) {
    return row.inverse_s > row.bcs_s && row.bcs_s > row.woodbury_s;
  });
  double worst = 0.0;
  int fewest = first.repeats;
  for (const Figure5Row& row : r.figure5) {
    worst = std::max(worst, row.largest_error);
    fewest = std::min(fewest, row.repeats);
  }
  return paragraph(fmt::format(
             "A square of tissue in plane strain is meshed with linear triangles and fixed at one side. A node is "
             "added on an edge in the middle of the square: two triangles become four, ΔK is {0} × {0}, and K⁻¹ of "
             "order {1} to {2} has to be updated.",
             last.change, first.dim, last.dim)) +
         paragraph(
             "The labels of the paper’s figure suggest this order, from slowest to fastest: full inverse, boundary "
             "condition switches, matrix inversion lemma (Woodbury).") +
         paragraph(fmt::format(
             "Here, at order {}, the inverse takes {} from scratch, {} by switches, {} by Woodbury and {} by Woodbury "
             "on one triangle of the symmetric matrix. The switches take {:.1f} times as long as Woodbury at order {} "
             "and {:.1f} times at order {}. {}",
             last.dim, duration(last.inverse_s), duration(last.bcs_s), duration(last.woodbury_s),
             duration(last.woodbury_symmetric_s), first.bcs_s / first.woodbury_s, first.dim,
             last.bcs_s / last.woodbury_s, last.dim,
             ordered ? "The methods have the paper’s order at every size."
                     : "The methods do not have the paper’s order at every size; the points in the plot show where.")) +
         paragraph(fmt::format(
             "The switches need {:.2f} times as many multiplications (counted) as Woodbury at order {} and {:.2f} "
             "times at order {}. In addition, Woodbury reads and writes K⁻¹ once, in one matrix product. The switches "
             "read and write it once for each degree of freedom of ΔK that is switched off and once for each that is "
             "switched back, {} times here, because new degrees of freedom are only switched back.",
             first.bcs_multiplications / first.woodbury_multiplications, first.dim,
             last.bcs_multiplications / last.woodbury_multiplications, last.dim, 2 * last.change - last.added)) +
         paragraph(
             fmt::format("The times are medians of at least {} repeats. Every result is compared with the inverse "
                         "from scratch; the largest difference is {}.",
                         fewest, order(worst)));
}

std::string force_plots(const Figure6& figure) {
  std::string html;
  for (const Figure6Run& run : figure.runs) {
    std::string title = run.variant.label;
    if (run.variant.id == "default") title = "This program’s default for node addition";
    if (run.variant.id == "bcs_repositioning") title = "Switches, node repositioning";
    html += "<figure class=\"force-run\"><figcaption>" + html_escaped(title) +
            "</figcaption><div class=\"plot forces\" id=\"forces-" + run.variant.id + "\"></div></figure>";
  }
  return html;
}

std::string figure2_intro(const Reproduction& r) {
  const Figure2& f = r.figure2;
  return paragraph(fmt::format(
      "The mesher drops a contour point that lies less than {:g} mm from the contour without it. Of the {} points of "
      "the {} it keeps {}. Filled points are kept, hollow points are dropped. The surface is the boundary of the "
      "tetrahedra used in the insertions above. Drag the solids to turn them.",
      f.cull_mm, f.points(), f.organ, f.points_kept()));
}

std::string segment_figures(const Reproduction& r) {
  const auto one = [](const std::string& title, const std::string& id, const std::string& text) {
    return "<figure><figcaption>" + html_escaped(title) + "</figcaption><div class=\"drawing\" id=\"" + id +
           "\"></div>" + paragraph(text) + "</figure>";
  };
  return one("Needle segment, symmetric", "segment",
             fmt::format("The tetrahedral needle consists of such segments: {} tetrahedra around the axis, with the "
                         "same arrangement in opposite directions. The drawing is twice as long as wide.",
                         r.figure2.symmetric.tets.size())) +
         one("Needle segment, asymmetric", "asymmetric",
             fmt::format(
                 "This segment is shown for comparison and not used: {} tetrahedra, with all diagonals rising in the "
                 "same direction, so that opposite directions differ.",
                 r.figure2.asymmetric.tets.size()));
}

std::string cell(const TableCell& cell, bool best) {
  std::string text = "";
  if (const auto* value = std::get_if<double>(&cell)) text = digits(*value);
  if (const auto* words = std::get_if<std::string>(&cell)) text = *words;
  return fmt::format("<td class=\"number{}\">{}</td>", best ? " best" : "", html_escaped(text));
}

std::string table_rows(const std::vector<TableRow>& rows) {
  std::string html;
  std::string group;
  for (const TableRow& row : rows) {
    if (row.group != group) {
      group = row.group;
      html += "<tr class=\"group\"><th colspan=\"6\">" + html_escaped(group) + "</th></tr>";
    }
    const auto* theirs = std::get_if<double>(&row.reproduced);
    const auto* ours = std::get_if<double>(&row.ours);
    const bool compared = theirs != nullptr && ours != nullptr && !row.unit.empty() && *ours < *theirs;
    html += "<tr><td>" + html_escaped(row.quantity) + "</td><td>" + html_escaped(row.unit) + "</td>" +
            cell(row.paper, false) + cell(row.reproduced, false) + cell(row.ours, compared) + "<td>" +
            html_escaped(row.note) + "</td></tr>";
  }
  return html;
}

std::string credibility(const Reproduction& r) {
  const double seconds = 2.0 * r.counted.woodbury / (stated::kFlopPerCycle * stated::kClock_Hz);
  return paragraph(fmt::format(
      "The paper states iterations of less than {:g} ms with Woodbury. On its mesh one update of the whole inverse "
      "needs {:.0f} million multiplications and as many additions. The paper’s processor could do at most one of each "
      "per cycle at {:g} GHz, so the update takes at least {:.1f} ms, or about {:.1f} ms if symmetry is used. The "
      "paper’s number can therefore be right for iterations that do not change the mesh, or for an update of a part of "
      "the inverse, but not for an iteration that updates all of K⁻¹. Here an update of order {} by {} rows takes {} "
      "on one core, and {} if symmetry is used.",
      1e3 * stated::kWoodburyBelow_s, 1e-6 * r.counted.woodbury, 1e-9 * stated::kClock_Hz, 1e3 * seconds,
      0.5e3 * seconds, r.on_faces.dofs, r.on_faces.change, duration(r.on_faces.woodbury_full.median_s),
      duration(r.on_faces.woodbury_update_s)));
}

std::string pair(const std::string& name, const std::string& value) {
  return "<dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(value) + "</dd>";
}

/// The BLAS library and its number of threads, as far as they are known.
std::string blas_text(const measure::Machine& machine) {
  return (machine.blas.empty() ? std::string("BLAS of the system") : machine.blas) +
         (machine.blas_threads == 1 ? ", one thread" : ", number of threads unknown");
}

std::string how_made(const Reproduction& r) {
  return pair("Command", r.options.command) +
         pair("Machine", fmt::format("{}, {} cores", r.machine.processor, r.machine.cores)) +
         pair("BLAS", blas_text(r.machine)) + pair("Compiler", r.machine.compiler) +
         pair("Program", "Stylet " + r.version) + pair("Duration", fmt::format("{:.0f} s", r.seconds)) +
         pair("Extent", r.options.quick ? "--quick: fewer sizes and repeats, one shorter insertion, larger time step"
                                        : "all sizes, repeats and insertions");
}

std::string notes_box(const std::vector<std::string>& notes) {
  if (notes.empty()) return {};
  std::string html = "<ul class=\"warnings\">";
  for (const std::string& note : notes) html += "<li>" + html_escaped(note) + "</li>";
  return html + "</ul>";
}

std::string page_data(const Reproduction& r) {
  Json runs = reproduction_data(r)["fig6"]["runs"];
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i]["curves"] = curves_json(r.figure6.runs[i]);
  const Json data{{"fig2", figure2_json(r.figure2)}, {"fig5", reproduction_data(r)["fig5"]}, {"runs", runs}};
  return json_text(data);
}

}  // namespace

Result<std::string> reproduction_page(const Reproduction& r) {
  std::string files;
  for (const Figure6Run& run : r.figure6.runs)
    files += (files.empty() ? "<code>" : ", <code>") + html_escaped(curve_file(run)) + "</code>";
  const results::Slots slots{
      {"title", "Goksel et al. 2005, reproduced"},
      {"heading", "3D needle–tissue interaction, 2005 and now"},
      {"kicker", "The paper and this program"},
      {"facts", html_escaped(fmt::format("Goksel et al., MICCAI 2005 · {} nodes · {} · {}", r.figure6.nodes,
                                         r.machine.processor, blas_text(r.machine)))},
      {"tiles", tiles(r)},
      {"notes", notes_box(r.notes)},
      {"figure5", figure5_caption(r)},
      {"figure6", figure6_intro(r.figure6)},
      {"cumulative", cumulative_caption(r.figure6, r.inside)},
      {"force_plots", force_plots(r.figure6)},
      {"forces", forces_caption(r.figure6, r.figure2.organ)},
      {"dimensions", dimensions_caption(r.figure6)},
      {"figure2", figure2_intro(r)},
      {"segments", segment_figures(r)},
      {"table", table_rows(r.table)},
      {"credibility", credibility(r)},
      {"made", how_made(r)},
      {"repeats", r.figure6.repeats == 1
                      ? std::string("once")
                      : fmt::format("{} times, and the median time of each iteration is used", r.figure6.repeats)},
      {"tolerance", order(measure::kLargestDifference)},
      {"curve_files", files},
      {"no_script",
       "<noscript><p class=\"page note\">The plots need JavaScript. The same numbers are in the files beside this "
       "page.</p></noscript>\n"},
      {"data_id", "reproduction-data"},
      {"data", results::json_script_safe(page_data(r))},
  };
  return results::whole_page(results::reproduce_assets(), slots, "report.html");
}

}  // namespace stylet::reproduce
