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
      return "lies on the surface of an organ or of the patient";
    case RemeshEvent::Refused::fixed:
      return "is fixed";
    case RemeshEvent::Refused::held:
      return "is already held by the needle";
    case RemeshEvent::Refused::contacts:
      return "has contacts interpolated around it";
    case RemeshEvent::Refused::inverts:
      return "would flatten an element around it or turn it inside out";
    case RemeshEvent::Refused::no:
      break;
  }
  return "was not to be moved";
}

}  // namespace

std::string figure6_intro(const Figure6& figure) {
  std::string insertions;
  for (const std::string& insertion : figure.insertions)
    insertions += "<li>" + results::html_escaped(insertion) + "</li>";
  return paragraph(fmt::format(
             "The prostate of the demo patient and its surroundings are meshed with {} nodes and {} tetrahedra and "
             "fixed at the pubic side. The motion is an insertion of {}, in and out at {:g} mm/s, with {:g} ms per "
             "iteration. {} variants follow exactly the same motion of the base. The first is the paper’s first "
             "method: boundary condition switches, with a contact about every {:g} mm, to which the nearest node is "
             "moved. The second is the paper’s second method: Woodbury, with a node added wherever the tip enters an "
             "element. The third is this program’s default for node addition: a contact about every {:g} mm, for which "
             "a node is added inside an element; the compliance is kept only among the points held by the needle.",
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
    changing.push_back(fmt::format("{}: {} iterations, median {}, worst {}, together {}", label, changes,
                                   duration(run.median_s(true)), duration(run.worst_s(true)),
                                   duration(remeshing_s(run))));
    others.push_back(
        fmt::format("{}: median {}, worst {}", label, duration(run.median_s(false)), duration(run.worst_s(false))));
    ratios.push_back(fmt::format("{} ({})", digits(run.median_s(true) / run.median_s(false)), label));
    totals.push_back(fmt::format("{} ({})", duration(run.total_s()), label));
    in_retraction += remeshed_in_retraction(run);
  }
  return paragraph(fmt::format(
             "In the paper the curve of the switches rises in large steps, one for each repositioning, and is flat "
             "during retraction, when the mesh does not change. Here the ratio of the median time of iterations that "
             "change the mesh to the median time of iterations that do not is: {}. {} All iterations together take {}.",
             list(ratios, ", "),
             in_retraction == 0 ? std::string("No mesh changes during a retraction.")
                                : fmt::format("{} changes of the mesh occur during a retraction.", in_retraction),
             list(totals, ", "))) +
         paragraph(fmt::format("The plot on the right shows the iterations that change the mesh. {}. Each of these "
                               "iterations also solves for the equilibrium of needle and tissue. One change of the "
                               "mesh by the default alone takes {} (median, measured in isolation, see the table).",
                               list(changing, "; "), duration(inside.ours.median_s))) +
         paragraph(
             fmt::format("The plot on the left also contains the iterations that do not change the mesh. {}. They "
                         "solve for the equilibrium, by the same method in every variant; the iteration in which "
                         "a needle comes out also undoes the changes of the mesh.",
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
             "force while the tissue still sticks to the retracting needle, and the start of slip; their axes reach "
             "from {} to {:g} N. Here, of {} insertions ({} by each of {} variants): contact with the skin in {}, "
             "penetration of the {} in {}, the force turned from push to pull before slip in {}, start of slip in {}.",
             fmt::format("−{:g}", -paper_numbers::kForceAxisFrom_N), paper_numbers::kForceAxisTo_N,
             figure.runs.size() * figure.insertions.size(), figure.insertions.size(), figure.runs.size(), skin, organ,
             penetrated, reversed, slipped)) +
         (rests.empty() ? std::string()
                        : paragraph(fmt::format(
                              "While the needle rests at its deepest point, the axial force of the default changes {}. "
                              "Part of the friction grows with speed and does not act on a needle at rest.",
                              list(rests, ", then ")))) +
         paragraph(
             fmt::format("Largest axial forces: {}. Root mean square difference of the axial force from the axial "
                         "force of the default, in percent of the default’s peak: {}. The forces differ because "
                         "the variants do not hold the tissue by the same nodes.",
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
             "Order of ΔK. A node that is moved changes all elements around it: {}. A node added on a face changes the "
             "two elements that share the face, or the only element at the skin: {}. A node added inside an element "
             "changes this element: {}.",
             dimensions(bcs, true), dimensions(figure.run("woodbury_addition"), false),
             dimensions(figure.run("default"), false))) +
         paragraph(refused.empty() ? made
                                   : made + fmt::format("Otherwise a node was added inside the element, because the "
                                                        "nearest node {}.",
                                                        list(refused, ", or ")));
}

}  // namespace stylet::reproduce
