// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/narrative.hpp"

#include "stylet/io/event_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace stylet::results {
namespace {

/// Joins texts as "a, b and c".
std::string join(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k > 0) text += k + 1 == parts.size() ? " and " : ", ";
    text += parts[k];
  }
  return text;
}

/// A force such as "0.42 N", with fewer digits for small forces.
std::string newtons(double force) {
  return std::abs(force) < 0.005 ? "less than 0.01 N" : fmt::format("{:.2f} N", force);
}

std::string at_most(double force) { return (std::abs(force) < 0.005 ? "" : "at most ") + newtons(force); }

const Event* find(const std::vector<Event>& events, EventKind kind) {
  const auto found = std::find_if(events.begin(), events.end(), [&](const Event& e) { return e.kind == kind; });
  return found == events.end() ? nullptr : &*found;
}

std::string tell_motion(const RunRecording& run, const Frame& deepest) {
  const Event* out = find(run.summary->events, EventKind::withdrawn);
  const double end = run.steps.empty() ? run.frames.back().time_s : run.steps.back().time_s;
  const double last_depth = run.steps.empty() ? run.frames.back().base_depth_mm : run.steps.back().base_depth_mm;
  std::string text = fmt::format(
      "A needle of {:.3g} mm diameter was advanced until it reached {:.1f} mm beyond the entry point, after {:.1f} s",
      run.info.needle_diameter_mm, deepest.base_depth_mm, deepest.time_s);
  if (out != nullptr) return text + fmt::format("; it was drawn out again completely after {:.1f} s.", out->time_s);
  if (last_depth < deepest.base_depth_mm - 0.5) {
    return text + fmt::format("; it was drawn back to {:.1f} mm, where the run ended after {:.1f} s.", last_depth, end);
  }
  return text + ".";
}

/// What is said of an event besides its words and depth; empty: the event is not told, since it is no event on the way
/// in.
std::optional<std::string> rest_of_clause(const Event& e) {
  switch (e.kind) {
    case EventKind::puncture:
    case EventKind::bone_contact:
      return " under an axial force of " + newtons(e.force_N);
    case EventKind::grazed:
      return " without piercing it";
    case EventKind::skin_contact:
    case EventKind::region_entered:
    case EventKind::exited:
    case EventKind::re_entered:
      return "";
    case EventKind::retraction_start:
    case EventKind::slip_start:
    case EventKind::withdrawn:
      break;
  }
  return std::nullopt;
}

/// Sentences about the events on the way in, in their order.
std::string tell_events(const std::vector<Event>& events) {
  constexpr std::size_t kMost = 7;
  std::vector<std::string> clauses;
  EventWords words;
  for (const Event& e : events) {
    const std::string what = words.clause(e);
    const auto rest = rest_of_clause(e);
    if (!what.empty() && rest) clauses.push_back(fmt::format("{} at {:.1f} mm{}", what, e.depth_mm, *rest));
    if (clauses.size() == kMost) break;
  }
  return clauses.empty() ? std::string() : "The tip " + join(clauses) + ".";
}

std::string tell_forces(const RunRecording& run) {
  const Summary& s = *run.summary;
  const auto peak = std::max_element(run.steps.begin(), run.steps.end(), [](const auto& a, const auto& b) {
    return std::abs(a.force_axial_N) < std::abs(b.force_axial_N);
  });
  std::string where;
  if (peak != run.steps.end()) {
    where = fmt::format(", {} at a depth of {:.1f} mm", peak->force_axial_N >= 0 ? "pushing in" : "pulling back",
                        peak->base_depth_mm);
  }
  return fmt::format(
      "The hand had to exert {} along the needle{}; across it, {} in the sagittal and {} in the lateral direction.",
      at_most(s.peak_axial_N), where, at_most(s.peak_sagittal_N), at_most(s.peak_lateral_N));
}

std::string tell_target(const RunRecording& run) {
  const Summary& s = *run.summary;
  if (run.info.target_regions.empty()) return {};
  if (s.target_shift_max_mm < 0.05) {
    return fmt::format("With the needle at its deepest, the {} was at its initial place.", target_name(run));
  }
  return fmt::format(
      "With the needle at its deepest, the centre of the {} had moved by {:.2f} mm ({}); the point of it that moved "
      "most, by {:.1f} mm.",
      target_name(run), s.target_shift_centroid_mm.norm(), describe_shift(s.target_shift_centroid_mm),
      s.target_shift_max_mm);
}

/// Sentences about the tip error: the tip's place in the tissue compared with its planned place.
std::string tell_tip_error(const RunRecording& run) {
  const auto& error = run.summary->tip_error_mm;
  if (!error) return {};
  return fmt::format(
      "At the deepest point the tip was off its target by {:.1f} mm ({}): so far from the planned place lies, in the "
      "patient at rest, the tissue that it had reached. This is not the error of a seed, which lies in front of the "
      "tip.",
      error->norm(), describe_shift(*error));
}

/// Sentences about the needles in place, and about what counts from the tissue as they hold it.
std::string tell_in_place(const RunRecording& run) {
  const auto& held = run.summary->in_place;
  if (!held) return {};
  std::string text = fmt::format("Needles were in place in the {} {}, and stayed.",
                                 held->holes.size() == 1 ? "hole" : "holes", fmt::join(held->holes, ", "));
  if (held->shift_mm && held->shift_max_mm) {
    text +=
        fmt::format(" They had moved the {} by {:.2f} mm before; this needle moved it further by at most {:.2f} mm.",
                    target_name(run), held->shift_mm->norm(), held->shift_max_mm->norm());
  }
  if (held->tip_error_mm) {
    text += fmt::format(
        " Counted from the tissue that lay at the planned place while they were in, it was off by {:.1f} mm.",
        held->tip_error_mm->norm());
  }
  return text;
}

std::string tell_retraction(const RunRecording& run, const Frame& after) {
  const auto& events = run.summary->events;
  const Event* back = find(events, EventKind::retraction_start);
  if (back == nullptr) return {};
  std::string text = fmt::format("The needle was drawn back from {:.1f} s on.", back->time_s);
  const auto slip = std::find_if(events.begin(), events.end(), [&](const Event& e) {
    return e.kind == EventKind::slip_start && e.time_s >= back->time_s;
  });
  if (slip != events.end()) {
    text +=
        fmt::format(" For the first {:.1f} mm the tissue stuck to it and moved with it; then the needle began to slip.",
                    back->depth_mm - slip->depth_mm);
  }
  if (find(events, EventKind::withdrawn) != nullptr) {
    double left = 0;
    for (Eigen::Index n = 0; n + 2 < after.displacement.size(); n += 3) {
      left = std::max(left, after.displacement.segment<3>(n).norm());
    }
    text += left < 0.005
                ? " After the needle had left, the tissue was back in its initial shape."
                : fmt::format(" After the needle had left, the tissue was still displaced by up to {:.2f} mm.", left);
  }
  return text;
}

}  // namespace

std::string target_name(const RunRecording& run) {
  std::vector<std::string> names;
  for (const int r : run.info.target_regions)
    names.push_back(spoken_name(run.mesh.regions[static_cast<std::size_t>(r)]));
  return names.empty() ? "target" : join(names);
}

std::string describe_shift(const Vec3& shift) {
  return in_words(shift,
                  {{{"to the patient's left", "to the patient's right"},
                    {"backwards", "forwards"},
                    {"towards the head", "towards the feet"}}},
                  1);
}

std::string in_words(const Vec3& shift, const std::array<DirectionWords, 3>& words, int digits) {
  const double least = 0.5 * std::pow(10.0, -digits);
  std::array<Eigen::Index, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return std::abs(shift[a]) > std::abs(shift[b]); });
  std::vector<std::string> parts;
  for (const Eigen::Index k : order) {
    if (std::abs(shift[k]) < least) continue;
    const DirectionWords& word = words[static_cast<std::size_t>(k)];
    parts.push_back(
        fmt::format("{:.{}f} mm {}", std::abs(shift[k]), digits, shift[k] > 0 ? word.positive : word.negative));
  }
  return parts.empty() ? fmt::format("less than {:.{}f} mm in any direction", least, digits + 1) : join(parts);
}

std::vector<std::string> tell_what_happened(const RunRecording& run, const Moments& moments) {
  const Frame& deepest = run.frames[moments.deepest];
  const Summary& s = *run.summary;
  std::vector<std::string> paragraphs;
  const auto add = [&](const std::vector<std::string>& sentences) {
    std::string paragraph;
    for (const std::string& sentence : sentences) {
      if (sentence.empty()) continue;
      if (!paragraph.empty()) paragraph += ' ';
      paragraph += sentence;
    }
    if (!paragraph.empty()) paragraphs.push_back(paragraph);
  };
  add({tell_motion(run, deepest), tell_events(s.events)});
  add({tell_forces(run), tell_target(run), tell_tip_error(run), tell_in_place(run),
       fmt::format("The tip was at most {:.1f} mm away from the straight line along which it was aimed.",
                   s.tip_deflection_mm)});
  add({tell_retraction(run, run.frames[moments.after])});
  return paragraphs;
}

std::string tell_step_times(const Summary& s) {
  return fmt::format(
      "{} steps were computed. Half of them took at most {:.0f} µs of processor time, 99 % at most {:.0f} µs, 99.9 % "
      "at "
      "most {:.0f} µs; the slowest took {:.0f} µs. A control loop at 1 kHz leaves 1000 µs for a step.",
      s.steps, s.step_us_p50, s.step_us_p99, s.step_us_p999, s.step_us_max);
}

}  // namespace stylet::results
