// SPDX-License-Identifier: GPL-3.0-or-later
#include "figure6_text.hpp"

#include "page_text.hpp"
#include "report/text.hpp"
#include "stylet/evidence/reproduce/paper_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace stylet::reproduce {

namespace {

std::string list(const std::vector<std::string>& parts, const char* between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

/// Smallest and largest order of ΔK among the changes of one kind (node moved or node added), as text.
std::string dimensions(const Figure6Run& run, bool moved) {
  int least = 0;
  int most = 0;
  for (const Figure6Remesh& r : run.remeshes) {
    if ((r.event.kind == RemeshEvent::Kind::repositioned) != moved) continue;
    least = least == 0 ? r.event.dimension : std::min(least, r.event.dimension);
    most = std::max(most, r.event.dimension);
  }
  if (most == 0) return "none here";
  return least == most ? fmt::format("{0} × {0} here", most) : fmt::format("{0} × {0} to {1} × {1} here", least, most);
}

/// Time of all iterations that changed the mesh [s].
double remeshing_s(const Figure6Run& run) {
  double sum = 0.0;
  for (std::size_t i = 0; i < run.steps.size(); ++i)
    if (run.remeshings[i] > 0) sum += 1e-6 * run.steps[i].step_us;
  return sum;
}

/// The iteration of an insertion's first event of a kind.
std::optional<std::size_t> when(const Figure6Run& run, std::size_t insertion, EventKind kind,
                                const std::string& region = {}) {
  for (const Figure6Event& e : run.events)
    if (e.insertion == insertion && e.event.kind == kind && (region.empty() || e.event.region == region))
      return e.iteration;
  return std::nullopt;
}

/// Number of changes of the mesh while a needle is drawn back.
int remeshed_in_retraction(const Figure6Run& run) {
  return static_cast<int>(std::count_if(run.remeshes.begin(), run.remeshes.end(), [&](const Figure6Remesh& r) {
    const auto turned = when(run, r.insertion, EventKind::retraction_start);
    return turned && r.iteration >= *turned;
  }));
}

/// Whether the hand pushes when it turns back and already pulls when slip starts. Then the tissue sticks to the needle
/// while the force reverses.
bool reverses_while_stuck(const Figure6Run& run, std::size_t insertion) {
  const auto turned = when(run, insertion, EventKind::retraction_start);
  const auto slipped = when(run, insertion, EventKind::slip_start);
  if (!turned || !slipped || *turned == 0 || *slipped < *turned) return false;
  return run.steps[*turned - 1].force_axial_N > 0.0 && run.steps[*slipped].force_axial_N < 0.0;
}

/// Axial force [N] directly before the base comes to rest at its deepest point, and at the end of this rest.
std::optional<std::pair<double, double>> force_at_rest(const Figure6Run& run, std::size_t insertion) {
  constexpr double still_mm = 1e-6;
  std::size_t from = 0;  // first and last iteration at the greatest depth
  std::size_t to = 0;
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    if (run.insertion[i] != insertion) continue;
    const double depth = run.steps[i].base_depth_mm;
    if (depth > deepest + still_mm) {
      deepest = depth;
      from = i;
    }
    if (depth > deepest - still_mm) to = i;
  }
  if (from == 0 || to == from || run.insertion[from - 1] != insertion) return std::nullopt;
  return std::pair{run.steps[from - 1].force_axial_N, run.steps[to].force_axial_N};
}

/// Largest absolute axial force [N].
double peak(const Figure6Run& run) {
  double most = 0.0;
  for (const Step& step : run.steps) most = std::max(most, std::abs(step.force_axial_N));
  return most;
}

/// Root mean square difference of the axial forces of two runs, relative to the peak of the second [%].
double difference_percent(const Figure6Run& run, const Figure6Run& other) {
  double sum = 0.0;
  const std::size_t count = std::min(run.steps.size(), other.steps.size());
  for (std::size_t i = 0; i < count; ++i) sum += std::pow(run.steps[i].force_axial_N - other.steps[i].force_axial_N, 2);
  return 100.0 * std::sqrt(sum / static_cast<double>(std::max<std::size_t>(count, 1))) / peak(other);
}

std::string in_newtons(double force) { return fmt::format("{}{:.2f} N", force < 0.0 ? "−" : "", std::abs(force)); }

std::string why_not_moved(RemeshEvent::Refused refused) {
  switch (refused) {
    case RemeshEvent::Refused::boundary:
      return "makes the shape of an organ or of the patient";
    case RemeshEvent::Refused::fixed:
      return "is fixed";
    case RemeshEvent::Refused::held:
      return "is held by the needle already";
    case RemeshEvent::Refused::contacts:
      return "has contacts interpolated around it";
    case RemeshEvent::Refused::inverts:
      return "would flatten an element around it or turn it inside out";
    case RemeshEvent::Refused::no:
      break;
  }
  return "was not asked to move";
}

}  // namespace

std::string figure6_intro(const Figure6& figure) {
  std::string insertions;
  for (const std::string& insertion : figure.insertions)
    insertions += "<li>" + results::html_escaped(insertion) + "</li>";
  return paragraph(fmt::format(
             "The demo patient’s prostate and its surroundings, meshed with {} nodes and {} tetrahedra, held at its "
             "pubic side; {}, in and out at {:g} mm/s, {:g} ms an iteration. {} variants follow exactly the same "
             "motion of the base: the paper’s first way (boundary condition switches; a contact about every {:g} mm, "
             "and the "
             "node nearest to the tip is moved there), its second (Woodbury; a node is added wherever the tip enters "
             "an element), and this program’s default for node addition (a contact about every {:g} mm, a node added "
             "inside an element; "
             "compliance among the points held only).",
             figure.nodes, figure.tets,
             figure.insertions.size() == 1 ? std::string("one needle")
                                           : fmt::format("{} needles one after the other", figure.insertions.size()),
             figure.speed_mm_per_s, figure.dt_ms, figure.runs.size(), figure.spacing_mm, figure.spacing_mm)) +
         "<ul>" + insertions + "</ul>";
}

std::string cumulative_caption(const Figure6& figure, const measure::RemeshCost& inside) {
  std::vector<std::string> changing;
  std::vector<std::string> others;
  std::vector<std::string> ratios;
  std::vector<std::string> totals;
  int in_retraction = 0;
  for (const Figure6Run& run : figure.runs) {
    const std::string& label = run.variant.label;
    const auto changes = static_cast<int>(
        std::count_if(run.remeshings.begin(), run.remeshings.end(), [](int made) { return made > 0; }));
    changing.push_back(fmt::format("{}: {} of them, median {}, worst {}, together {}", label, changes,
                                   duration(run.median_s(true)), duration(run.worst_s(true)),
                                   duration(remeshing_s(run))));
    others.push_back(
        fmt::format("{}: median {}, worst {}", label, duration(run.median_s(false)), duration(run.worst_s(false))));
    ratios.push_back(fmt::format("{} ({})", digits(run.median_s(true) / run.median_s(false)), label));
    totals.push_back(fmt::format("{} ({})", duration(run.total_s()), label));
    in_retraction += remeshed_in_retraction(run);
  }
  return paragraph(fmt::format(
             "In the paper the curve of the switches climbs in big steps, one for each repositioning, and runs flat "
             "during retraction, when the mesh stays as it is. Here the median iteration that changes the mesh takes "
             "this many times as long as the median of those that do not: {}. {} All iterations together take {}.",
             list(ratios, ", "),
             in_retraction == 0 ? std::string("No mesh changes during a retraction.")
                                : fmt::format("{} changes of the mesh fall into a retraction.", in_retraction),
             list(totals, ", "))) +
         paragraph(fmt::format("Iterations that change the mesh, the plot on the right – {}. Each of them also finds "
                               "the balance of needle and tissue; one change of the mesh by the default takes {} by "
                               "itself (median, measured in isolation, see the table).",
                               list(changing, "; "), duration(inside.ours.median_s))) +
         paragraph(fmt::format("Iterations that leave the mesh alone, only in the plot on the left – {}. They find the "
                               "balance, by the same method in every variant, and when a needle comes out they forget "
                               "its changes of the mesh.",
                               list(others, "; ")));
}

std::string forces_caption(const Figure6& figure, const std::string& organ) {
  int skin = 0;
  int penetrated = 0;
  int reversed = 0;
  int slipped = 0;
  for (const Figure6Run& run : figure.runs) {
    for (std::size_t i = 0; i < figure.insertions.size(); ++i) {
      skin += when(run, i, EventKind::skin_contact).has_value() ? 1 : 0;
      penetrated += when(run, i, EventKind::puncture, organ).has_value() ? 1 : 0;
      reversed += reverses_while_stuck(run, i) ? 1 : 0;
      slipped += when(run, i, EventKind::slip_start).has_value() ? 1 : 0;
    }
  }
  const Figure6Run& ours = figure.run("default");
  std::vector<std::string> rests;
  for (std::size_t i = 0; i < figure.insertions.size(); ++i)
    if (const auto forces = force_at_rest(ours, i))
      rests.push_back(fmt::format("from {} to {}", in_newtons(forces->first), in_newtons(forces->second)));
  std::vector<std::string> peaks;
  std::vector<std::string> differences;
  for (const Figure6Run& run : figure.runs) {
    peaks.push_back(fmt::format("{} ({})", in_newtons(peak(run)), run.variant.label));
    if (&run != &ours)
      differences.push_back(fmt::format("{:.1f} % ({})", difference_percent(run, ours), run.variant.label));
  }
  return paragraph(fmt::format(
             "The paper’s curves show the contact with the skin, the penetration of the prostate, the reversal of the "
             "force while the tissue still sticks to the needle drawn back, and the start of slip; their axes reach "
             "from {} to {:g} N. Here, of {} insertions ({} by each of {} variants): contact with the skin in {}, "
             "penetration of the {} in {}, the force turned from push to pull before slip in {}, start of slip in {}.",
             fmt::format("−{:g}", -paper_numbers::kForceAxisFrom_N), paper_numbers::kForceAxisTo_N,
             figure.runs.size() * figure.insertions.size(), figure.insertions.size(), figure.runs.size(), skin, organ,
             penetrated, reversed, slipped)) +
         (rests.empty() ? std::string()
                        : paragraph(fmt::format(
                              "When the needle stops at its deepest and rests, the default’s axial force goes {}. Part "
                              "of the friction grows with speed, and a needle at rest is without it.",
                              list(rests, ", then ")))) +
         paragraph(fmt::format("Largest axial forces: {}. Root mean square difference of the axial force from the "
                               "default’s, in percent of its peak: {}. The variants do not hold the tissue by "
                               "the same nodes.",
                               list(peaks, ", "), list(differences, ", ")));
}

std::string dimensions_caption(const Figure6& figure) {
  const Figure6Run& bcs = figure.run("bcs_repositioning");
  std::map<RemeshEvent::Refused, int> reasons;
  int moved = 0;
  for (const Figure6Remesh& r : bcs.remeshes) {
    if (r.event.kind == RemeshEvent::Kind::repositioned)
      ++moved;
    else
      ++reasons[r.event.refused];
  }
  std::vector<std::string> refused;
  for (const auto& [reason, count] : reasons) refused.push_back(fmt::format("{} ({})", why_not_moved(reason), count));
  const std::string made =
      fmt::format("Of {} changes made, the repositioning moved a node {} times. ", bcs.remeshes.size(), moved);
  return paragraph(fmt::format(
             "A node that is moved changes all elements around it: {}. A node added on a face changes the two elements "
             "that share it, at the skin the only one: {}. A node added inside an element changes that one: {}.",
             dimensions(bcs, true), dimensions(figure.run("woodbury_addition"), false),
             dimensions(figure.run("default"), false))) +
         paragraph(refused.empty() ? made
                                   : made + fmt::format("Otherwise a node was added inside the element, since the "
                                                        "nearest one {}.",
                                                        list(refused, ", or ")));
}

}  // namespace stylet::reproduce
