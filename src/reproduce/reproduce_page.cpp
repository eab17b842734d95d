// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/assets.hpp"
#include "report/page_template.hpp"
#include "report/text.hpp"
#include "reproduction_data.hpp"
#include "stylet/coupling/paper/inverse_updates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet::reproduce {

using results::html_escaped;
using results::html_prose;

namespace {

/// 5·10⁻¹³: a small number by its order.
std::string order(double value) {
  if (!(value > 0.0)) return "0";
  static const std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const int exponent = static_cast<int>(std::floor(std::log10(value)));
  std::string text = fmt::format("{:.0f}·10⁻", value / std::pow(10.0, exponent));
  for (const char digit : std::to_string(-exponent)) text += raised[static_cast<std::size_t>(digit - '0')];
  return text;
}

/// Three significant digits, without an exponent; thousands in groups.
std::string digits(double value) {
  const double size = std::abs(value);
  if (!std::isfinite(value)) return "–";
  if (size == std::floor(size) && size < 1e6) return fmt::format("{:.0f}", value);
  if (size >= 99.95) return fmt::format("{:.0f}", value);
  if (size >= 9.995) return fmt::format("{:.1f}", value);
  if (size >= 0.9995) return fmt::format("{:.2f}", value);
  if (size >= 1e-4) return fmt::format("{:.{}f}", value, 2 - static_cast<int>(std::floor(std::log10(size))));
  return order(value);
}

/// A time with the unit that suits it.
std::string duration(double seconds) {
  const double size = std::abs(seconds);
  if (size < 1e-3) return digits(1e6 * seconds) + " µs";
  if (size < 1.0) return digits(1e3 * seconds) + " ms";
  return digits(seconds) + " s";
}

std::string paragraph(const std::string& text) { return "<p>" + html_prose(text) + "</p>"; }

std::string tile(const std::string& value, const std::string& caption) {
  return "<li><b>" + html_escaped(value) + "</b><span>" + html_escaped(caption) + "</span></li>";
}

const Figure6Run& run_of(const Figure6& figure, const std::string& id) {
  for (const Figure6Run& run : figure.runs)
    if (run.variant.id == id) return run;
  return figure.runs.back();
}

/// Smallest and largest order of ΔK among the changes of one kind.
std::string dimensions(const Figure6Run& run, bool moved) {
  int least = 0;
  int most = 0;
  for (const Figure6Remesh& r : run.remeshes) {
    if ((r.event.kind == RemeshEvent::Kind::repositioned) != moved) continue;
    least = least == 0 ? r.event.dimension : std::min(least, r.event.dimension);
    most = std::max(most, r.event.dimension);
  }
  if (most == 0) return "none";
  return least == most ? fmt::format("{0} × {0}", most) : fmt::format("{0} × {0} to {1} × {1}", least, most);
}

int count_of(const Figure6Run& run, RemeshEvent::Kind kind) {
  return static_cast<int>(
      std::count_if(run.remeshes.begin(), run.remeshes.end(), [&](const auto& r) { return r.event.kind == kind; }));
}

std::string tiles(const Reproduction& r) {
  const Figure6Run& bcs = run_of(r.figure6, "bcs_repositioning");
  const Figure6Run& woodbury = run_of(r.figure6, "woodbury_addition");
  const Figure6Run& ours = run_of(r.figure6, "default");
  return tile(fmt::format("{} nodes", r.figure6.nodes),
              fmt::format("{} tetrahedra; the paper: 570 and 2801", r.figure6.tets)) +
         tile(duration(bcs.worst_s(true)), "worst iteration by switches; the paper: 2.75 s") +
         tile(duration(woodbury.worst_s(true)), "worst iteration by Woodbury; the paper: less than 1 ms") +
         tile(duration(ours.worst_s(true)), "worst iteration of the default that changes the mesh") +
         tile(duration(r.inside.ours.median_s), "the default’s whole change of the mesh, median") +
         tile(digits(r.inside.woodbury.median_s / r.inside.ours.median_s) + " ×",
              "as long takes the same change by Woodbury");
}

std::string figure5_caption(const Reproduction& r) {
  if (r.figure5.empty()) return {};
  const Figure5Row& first = r.figure5.front();
  const Figure5Row& last = r.figure5.back();
  const bool ordered = std::all_of(r.figure5.begin(), r.figure5.end(), [](const Figure5Row& row) {
    return row.inverse_s > row.bcs_s && row.bcs_s > row.woodbury_s;
  });
  double worst = 0.0;
  for (const Figure5Row& row : r.figure5) worst = std::max(worst, row.largest_error);
  return paragraph(fmt::format(
             "A square of tissue in plane strain, linear triangles, one side held. A node is added on an edge in its "
             "middle, two triangles become four, ΔK is {0} × {0}, and K⁻¹ of order {1} to {2} has to follow.",
             last.change, first.dim, last.dim)) +
         paragraph(
             "The paper shows the full inverse as the slowest way, boundary condition switches below it, and the "
             "matrix "
             "inversion lemma (Woodbury) pulling ahead of the switches as the matrix grows.") +
         paragraph(fmt::format(
             "Here: at order {}, {} from scratch, {} by switches, {} by Woodbury, {} on one triangle of the symmetric "
             "matrix. Woodbury is {:.1f} times as fast as the switches at order {} and {:.1f} times at order {}. {}",
             last.dim, duration(last.inverse_s), duration(last.bcs_s), duration(last.woodbury_s),
             duration(last.woodbury_symmetric_s), first.bcs_s / first.woodbury_s, first.dim,
             last.bcs_s / last.woodbury_s, last.dim,
             ordered ? "The order is the paper’s at every size."
                     : "At some sizes the order is another than the paper’s; the points show where.")) +
         paragraph(
             "Switches and Woodbury do almost the same number of operations. The lemma gathers them into one product "
             "of "
             "matrices, which goes over K⁻¹ once; the switches go over it once for each degree of freedom.") +
         paragraph(fmt::format("Medians; every result is checked against the inverse from scratch, largest difference "
                               "{}.",
                               order(worst)));
}

std::string figure6_intro(const Reproduction& r) {
  std::string insertions;
  for (const std::string& insertion : r.figure6.insertions) insertions += "<li>" + html_escaped(insertion) + "</li>";
  return paragraph(fmt::format(
             "The demo patient’s prostate and its surroundings, meshed with {} nodes and {} tetrahedra, held at its "
             "pubic side; {} one after the other, in and out at {:g} mm/s, {:g} ms an iteration. Three variants "
             "follow exactly the same motion: the paper’s first way (boundary condition switches; the nearest node is "
             "moved to the tip), its second (Woodbury; a node is added wherever the tip enters an element), and this "
             "program’s default (nodes inside elements, compliance among the points held only).",
             r.figure6.nodes, r.figure6.tets, r.figure6.insertions.size() == 1 ? "one needle" : "two needles",
             r.figure6.speed_mm_per_s, r.figure6.dt_ms)) +
         "<ul>" + insertions + "</ul>";
}

/// Time of all iterations that changed the mesh [s].
double remeshing_s(const Figure6Run& run) {
  double sum = 0.0;
  for (std::size_t i = 0; i < run.steps.size(); ++i)
    if (run.remeshings[i] > 0) sum += 1e-6 * run.steps[i].step_us;
  return sum;
}

/// Changes of the mesh while a needle is drawn back.
int remeshed_in_retraction(const Figure6Run& run) {
  int count = 0;
  bool retracting = false;
  auto event = run.events.begin();
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    for (; event != run.events.end() && event->iteration == i; ++event) {
      if (event->event.kind == EventKind::retraction_start) retracting = true;
      if (event->event.kind == EventKind::withdrawn) retracting = false;
    }
    if (retracting) count += run.remeshings[i];
  }
  return count;
}

std::string cumulative_caption(const Reproduction& r) {
  const Figure6Run& bcs = run_of(r.figure6, "bcs_repositioning");
  const Figure6Run& woodbury = run_of(r.figure6, "woodbury_addition");
  const Figure6Run& ours = run_of(r.figure6, "default");
  const auto told = [](const Figure6Run& run) {
    return fmt::format("{} of them, median {}, worst {}, together {}", run.remeshes.size(),
                       duration(run.median_s(true)), duration(run.worst_s(true)), duration(remeshing_s(run)));
  };
  int in_retraction = 0;
  for (const Figure6Run& run : r.figure6.runs) in_retraction += remeshed_in_retraction(run);
  const std::string seen = in_retraction == 0
                               ? "The same steps are seen here, and none during retraction."
                               : fmt::format("{} changes of the mesh fall into a retraction here.", in_retraction);
  const std::string paper =
      "In the paper the curve of the switches climbs in big steps, one for each repositioning, and runs flat during "
      "retraction, when the mesh stays as it is; Woodbury with node addition stays far below. ";
  const std::string between = fmt::format(
      " Between them all three variants climb alike: our balance of needle and tissue, the same for all, takes {} an "
      "iteration (median). The plot on the right leaves these iterations out.",
      duration(ours.median_s(false)));
  const std::string changes = fmt::format(
      "Iterations that change the mesh: switches with repositioning, {}; Woodbury with node addition, {}; default, {}. "
      "Each includes the balance; of the default’s, the change of the mesh itself takes about {}.",
      told(bcs), told(woodbury), told(ours), duration(r.inside.ours.median_s));
  return paragraph(paper + seen + between) + paragraph(changes);
}

std::string force_plots(const Reproduction& r) {
  std::string html;
  for (const Figure6Run& run : r.figure6.runs) {
    std::string title = run.variant.label;
    if (run.variant.id == "default") title = "This program’s default";
    if (run.variant.id == "bcs_repositioning") title = "Switches, node repositioning";
    html += "<figure class=\"force-run\"><figcaption>" + html_escaped(title) +
            "</figcaption><div class=\"plot forces\" id=\"forces-" + run.variant.id + "\"></div></figure>";
  }
  return html;
}

/// Largest absolute axial force [N].
double peak(const Figure6Run& run) {
  double most = 0.0;
  for (const StepRecord& step : run.steps) most = std::max(most, std::abs(step.force_axial_N));
  return most;
}

/// Root mean square difference of the axial forces of two runs over the second's peak [%].
double difference_percent(const Figure6Run& run, const Figure6Run& other) {
  double sum = 0.0;
  const std::size_t count = std::min(run.steps.size(), other.steps.size());
  for (std::size_t i = 0; i < count; ++i) sum += std::pow(run.steps[i].force_axial_N - other.steps[i].force_axial_N, 2);
  return 100.0 * std::sqrt(sum / static_cast<double>(std::max<std::size_t>(count, 1))) / peak(other);
}

std::string forces_caption(const Reproduction& r) {
  const Figure6Run& ours = run_of(r.figure6, "default");
  std::string peaks;
  for (const Figure6Run& run : r.figure6.runs)
    peaks += fmt::format("{}{:.2f} N ({})", peaks.empty() ? "" : ", ", peak(run), run.variant.label);
  return paragraph(
             "The paper’s curves show the contact with the skin, the penetration of the prostate, the reversal of the "
             "force while the tissue still sticks to the needle drawn back, and the start of slip; their axes reach "
             "from "
             "−0.6 to 0.9 N. The same features are marked here. Force falls at the end of the way in because friction "
             "has a part that grows with speed, and the needle stops.") +
         paragraph(
             fmt::format("Largest axial forces: {}. The axial force of the switches with repositioning differs from "
                         "the default’s by {:.1f} % of its peak (root mean square), that of Woodbury with node "
                         "addition by {:.1f} %: each variant has its nodes in other places.",
                         peaks, difference_percent(run_of(r.figure6, "bcs_repositioning"), ours),
                         difference_percent(run_of(r.figure6, "woodbury_addition"), ours)));
}

std::string dimensions_caption(const Reproduction& r) {
  const Figure6Run& bcs = run_of(r.figure6, "bcs_repositioning");
  const Figure6Run& woodbury = run_of(r.figure6, "woodbury_addition");
  const Figure6Run& ours = run_of(r.figure6, "default");
  return paragraph(fmt::format(
             "A node that is moved changes all elements around it, and their number varies: {} here. A node on a face "
             "changes two elements: {} (at the skin one element). A node inside an element: {}.",
             dimensions(bcs, true), dimensions(woodbury, false), dimensions(ours, false))) +
         paragraph(fmt::format(
             "Of {} changes asked for, the repositioning moved a node {} times. Otherwise the nearest node was one "
             "that makes the shape of an organ, is held, or cannot go there without an element turning inside out; "
             "then "
             "a node was added, and reproduce.json says why.",
             bcs.remeshes.size(), count_of(bcs, RemeshEvent::Kind::repositioned)));
}

std::string figure2_intro(const Reproduction& r) {
  const Figure2& f = r.figure2;
  return paragraph(fmt::format(
      "The mesher drops contour points that lie nearer than {:g} mm to the contour without them; of {} points of the "
      "{} "
      "it keeps {}. Filled: kept, hollow: dropped. The surface is that of the tetrahedra of the insertions above. Drag "
      "the solids to turn them.",
      f.cull_mm, f.points(), f.organ, f.points_kept()));
}

std::string segment_figures(const Reproduction& r) {
  const auto one = [](const std::string& title, const std::string& id, const std::string& text) {
    return "<figure><figcaption>" + html_escaped(title) + "</figcaption><div class=\"drawing\" id=\"" + id +
           "\"></div>" + paragraph(text) + "</figure>";
  };
  return one("Needle segment, symmetric", "segment",
             fmt::format("The tetrahedral needle is built of these: {} tetrahedra around the axis, alike in every "
                         "direction it may bend. Drawn twice as long as wide.",
                         r.figure2.symmetric.tets.size())) +
         one("Needle segment, asymmetric", "asymmetric",
             fmt::format("For comparison: {} tetrahedra, every diagonal rising the same way. A needle of these moves "
                         "sideways under a load that is straight.",
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
  return paragraph(
      fmt::format("The paper states iterations of less than 1 ms with Woodbury. On its mesh one update of the whole "
                  "inverse is {:.0f} "
                  "million multiplications and as many additions; its processor could do at most one of each in a "
                  "cycle of 3.2 GHz. So "
                  "the figure can hold for iterations that leave the mesh alone, or for a part of the inverse, but not "
                  "for one that "
                  "changes all of K⁻¹. Here the same update takes {} on one core, {} using symmetry.",
                  1e-6 * paper::cost_of_woodbury(3 * 570, 3 * 6), duration(r.on_faces.woodbury_full.median_s),
                  duration(r.on_faces.woodbury_update_s)));
}

std::string pair(const std::string& name, const std::string& value) {
  return "<dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(value) + "</dd>";
}

/// The library and its threads, as far as they are known.
std::string blas_text(const Machine& machine) {
  return (machine.blas.empty() ? std::string("of the system") : machine.blas) +
         (machine.blas_threads == 1 ? ", one thread" : ", number of threads not known");
}

std::string how_made(const Reproduction& r) {
  return pair("Command", r.options.command) +
         pair("Machine", fmt::format("{}, {} cores", r.machine.processor, r.machine.cores)) +
         pair("BLAS", blas_text(r.machine)) + pair("Compiler", r.machine.compiler) +
         pair("Program", "Stylet " + r.version) + pair("Duration", fmt::format("{:.0f} s", r.seconds)) +
         pair("Extent", r.options.quick ? "--quick: fewer sizes and repeats, one shorter insertion, larger time step"
                                        : "everything");
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
  return data.dump();
}

}  // namespace

Result<std::string> reproduction_page(const Reproduction& r) {
  std::string files;
  for (const Figure6Run& run : r.figure6.runs)
    files += (files.empty() ? "<code>" : ", <code>") + html_escaped(curve_file(run)) + "</code>";
  const results::Slots slots{
      {"version", html_escaped(r.version)},
      {"facts", html_escaped(fmt::format("Goksel et al., MICCAI 2005 · {} nodes · {} · {}", r.figure6.nodes,
                                         r.machine.processor, blas_text(r.machine)))},
      {"css", std::string(results::reproduce_css())},
      {"tiles", tiles(r)},
      {"notes", notes_box(r.notes)},
      {"figure5", figure5_caption(r)},
      {"figure6", figure6_intro(r)},
      {"cumulative", cumulative_caption(r)},
      {"force_plots", force_plots(r)},
      {"forces", forces_caption(r)},
      {"dimensions", dimensions_caption(r)},
      {"figure2", figure2_intro(r)},
      {"segments", segment_figures(r)},
      {"table", table_rows(r.table)},
      {"credibility", credibility(r)},
      {"made", how_made(r)},
      {"repeats", r.options.quick ? "every iteration of figure 6 was run once."
                                  : "every iteration of figure 6 was run three times, and the median counts."},
      {"curve_files", files},
      {"versions", html_escaped("Stylet " + r.version)},
      {"data", results::json_script_safe(page_data(r))},
      {"js", results::script_safe(results::reproduce_js())},
  };
  return results::fill_page(results::reproduce_template(), slots, "report.html");
}

}  // namespace stylet::reproduce
