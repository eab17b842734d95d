// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report_data.hpp"

#include "record/json.hpp"
#include "report/narrative.hpp"
#include "report/text.hpp"
#include "stylet/io/event_words.hpp"
#include "stylet/io/hole_map_io.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace stylet::results {
namespace {

static_assert(std::endian::native == std::endian::little, "typed arrays in the report are little-endian");

using record::Json;

constexpr std::size_t kMostSteps = 40000;                // largest number of points of a curve
constexpr std::size_t kMostDisplacementBytes = 6 << 20;  // largest size of all displacements, before base 64

/// Indices of the steps to show: all, or the steps with the smallest and the largest axial force of each group of
/// consecutive steps.
std::vector<std::size_t> thin_out(const std::vector<Step>& steps) {
  std::vector<std::size_t> kept;
  if (steps.size() <= kMostSteps) {
    kept.resize(steps.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const std::size_t buckets = kMostSteps / 2;
  for (std::size_t b = 0; b < buckets; ++b) {
    const auto first = steps.begin() + static_cast<std::ptrdiff_t>(b * steps.size() / buckets);
    const auto last = steps.begin() + static_cast<std::ptrdiff_t>((b + 1) * steps.size() / buckets);
    const auto [low, high] = std::minmax_element(
        first, last, [](const Step& x, const Step& y) { return x.force_axial_N < y.force_axial_N; });
    kept.push_back(static_cast<std::size_t>(std::min(low, high) - steps.begin()));
    if (low != high) kept.push_back(static_cast<std::size_t>(std::max(low, high) - steps.begin()));
  }
  return kept;
}

template <class Record, class Value>
std::string column(const std::vector<Record>& steps, const std::vector<std::size_t>& kept, Value value) {
  std::vector<float> values;
  values.reserve(kept.size());
  for (const std::size_t k : kept) values.push_back(static_cast<float>(value(steps[k])));
  return base64_of<float>(values);
}

Json steps_json(const std::vector<Step>& steps) {
  const auto kept = thin_out(steps);
  return {{"count", kept.size()},
          {"time_s", column(steps, kept, [](const Step& s) { return s.time_s; })},
          {"depth_mm", column(steps, kept, [](const Step& s) { return s.base_depth_mm; })},
          {"axial_N", column(steps, kept, [](const Step& s) { return s.force_axial_N; })},
          {"sagittal_N", column(steps, kept, [](const Step& s) { return s.force_sagittal_N; })},
          {"lateral_N", column(steps, kept, [](const Step& s) { return s.force_lateral_N; })}};
}

/// The gland's shift after each step of steps_json(); null without a target.
Json gland_json(const RunRecording& run) {
  const std::vector<GlandStep>& path = run.summary->gland_path;
  if (path.size() != run.steps.size() || path.empty()) return nullptr;
  const auto kept = thin_out(run.steps);
  const auto shift = [&](Eigen::Index k) {
    return column(path, kept, [k](const GlandStep& s) { return s.shift_mm[k]; });
  };
  return {{"LR_mm", shift(0)}, {"AP_mm", shift(1)}, {"SI_mm", shift(2)}};
}

/// Histogram of the step times, with bins of equal ratio.
Json histogram_json(const std::vector<Step>& steps) {
  constexpr int kBinsPerDecade = 20;
  std::vector<double> times;
  for (const Step& s : steps) {
    if (std::isfinite(s.step_us) && s.step_us > 0) times.push_back(s.step_us);
  }
  if (times.empty()) return {{"edges_us", Json::array()}, {"counts", Json::array()}};
  const auto [low, high] = std::minmax_element(times.begin(), times.end());
  const int first = static_cast<int>(std::floor(std::log10(*low) * kBinsPerDecade));
  const int last = static_cast<int>(std::floor(std::log10(*high) * kBinsPerDecade));
  std::vector<std::size_t> counts(static_cast<std::size_t>(last - first + 1), 0);
  for (const double t : times) {
    const int bin = static_cast<int>(std::floor(std::log10(t) * kBinsPerDecade)) - first;
    ++counts[static_cast<std::size_t>(std::clamp(bin, 0, last - first))];
  }
  std::vector<double> edges;
  for (int b = first; b <= last + 1; ++b) edges.push_back(std::pow(10.0, static_cast<double>(b) / kBinsPerDecade));
  return {{"edges_us", edges}, {"counts", counts}};
}

/// The nodes on the surfaces of all regions, renumbered consecutively.
struct SurfaceNodes {
  std::vector<Index> nodes;           ///< number in the mesh, by the new number
  std::vector<std::uint32_t> number;  ///< (n) new number, by the number in the mesh

  SurfaceNodes(const TetMesh& mesh, std::span<const RegionView> regions) : number(mesh.nodes.size(), kNone) {
    for (const RegionView& view : regions) {
      for (const auto& t : view.triangles) {
        for (const Index n : t) {
          auto& place = number[static_cast<std::size_t>(n)];
          if (place != kNone) continue;
          place = static_cast<std::uint32_t>(nodes.size());
          nodes.push_back(n);
        }
      }
    }
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
};

Json surface_json(const TetMesh& mesh, std::span<const RegionView> regions, const SurfaceNodes& surface) {
  std::vector<float> points;
  for (const Index n : surface.nodes) {
    for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(mesh.nodes[static_cast<std::size_t>(n)][k]));
  }
  Json list = Json::array();
  for (const RegionView& view : regions) {
    std::vector<std::uint32_t> triangles;
    for (const auto& t : view.triangles) {
      for (const Index n : t) triangles.push_back(surface.number[static_cast<std::size_t>(n)]);
    }
    list.push_back({{"name", view.name},
                    {"label", view.label},
                    {"color", hex(view.colour)},
                    {"opacity", view.opacity},
                    {"target", view.target},
                    {"background", view.background},
                    {"triangles", base64_of<std::uint32_t>(triangles)}});
  }
  return {{"points_mm", base64_of<float>(points)}, {"regions", list}};
}

/// Chooses frames whose displacements fit into the page: first labelled ones, then evenly spaced ones of the others.
std::vector<std::size_t> choose_frames(const std::vector<Frame>& frames, std::size_t surface_nodes) {
  const std::size_t room =
      std::max<std::size_t>(3, kMostDisplacementBytes / (6 * std::max<std::size_t>(1, surface_nodes)));
  std::vector<std::size_t> labelled, others;
  for (std::size_t f = 0; f < frames.size(); ++f) (frames[f].label.empty() ? others : labelled).push_back(f);
  const std::size_t left = room > labelled.size() ? room - labelled.size() : 0;
  const std::size_t taken = std::min(left, others.size());
  std::vector<std::size_t> chosen = labelled;
  for (std::size_t k = 0; k < taken; ++k) chosen.push_back(others[k * others.size() / taken]);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

double largest_component(const std::vector<Frame>& frames) {
  double largest = 0;
  for (const Frame& f : frames) {
    if (f.displacement.size() > 0) largest = std::max(largest, f.displacement.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

Json frames_json(const RunRecording& run, const std::vector<std::size_t>& chosen, const SurfaceNodes& surface,
                 double scale) {
  Json list = Json::array();
  for (const std::size_t f : chosen) {
    const Frame& frame = run.frames[f];
    std::vector<std::int16_t> displacement;
    displacement.reserve(3 * surface.nodes.size());
    for (const Index n : surface.nodes) {
      for (int k = 0; k < 3; ++k) {
        displacement.push_back(static_cast<std::int16_t>(std::lround(frame.displacement[3 * n + k] / scale)));
      }
    }
    std::vector<float> needle, contacts;
    for (const Vec3& p : frame.needle) {
      for (int k = 0; k < 3; ++k) needle.push_back(static_cast<float>(p[k]));
    }
    for (const ContactView& c : frame.contacts) {
      for (int k = 0; k < 3; ++k) contacts.push_back(static_cast<float>(c.position[k]));
      contacts.push_back(c.tip ? 2.0F : c.sticking ? 1.0F : 0.0F);
    }
    list.push_back({{"time_s", frame.time_s},
                    {"depth_mm", frame.base_depth_mm},
                    {"label", readable_name(frame.label)},
                    {"displacement", base64_of<std::int16_t>(displacement)},
                    {"needle_mm", base64_of<float>(needle)},
                    {"contacts", base64_of<float>(contacts)}});
  }
  return list;
}

Json events_json(const std::vector<Event>& events) {
  Json list = Json::array();
  EventWords words;
  for (const Event& e : events) {
    const std::string label = words.label(e);
    if (label.empty()) continue;  // the puncture at the same place has been said
    list.push_back({{"kind", to_string(e.kind)},
                    {"label", label},
                    {"time_s", e.time_s},
                    {"depth_mm", e.depth_mm},
                    {"force_N", e.force_N}});
  }
  return list;
}

/// Largest displacement of a surface node in any frame [mm].
double largest_displacement(const std::vector<Frame>& frames, const SurfaceNodes& surface) {
  double largest = 0;
  for (const Frame& f : frames) {
    for (const Index n : surface.nodes) largest = std::max(largest, f.displacement.segment<3>(3 * n).norm());
  }
  return largest;
}

}  // namespace

std::string report_data(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                        const HoleMap* map) {
  const SurfaceNodes surface(run.mesh, regions);
  const auto chosen = choose_frames(run.frames, surface.nodes.size());
  constexpr double kLargestInteger = 32767;
  const double scale = std::max(largest_component(run.frames), 1e-6) / kLargestInteger;
  const auto shown = std::lower_bound(chosen.begin(), chosen.end(), moments.deepest);
  const Json json = {
      {"steps", steps_json(run.steps)},
      {"gland", gland_json(run)},
      {"map", map ? Json::parse(hole_map_json(*map)) : Json(nullptr)},
      {"events", events_json(run.summary->events)},
      {"histogram", histogram_json(run.steps)},
      {"surface", surface_json(run.mesh, regions, surface)},
      {"displacement_scale_mm", scale},
      {"displacement_max_mm", largest_displacement(run.frames, surface)},
      {"frames", frames_json(run, chosen, surface, scale)},
      {"first_frame", std::min<std::ptrdiff_t>(shown - chosen.begin(), static_cast<std::ptrdiff_t>(chosen.size()) - 1)},
      {"needle_diameter_mm", run.info.needle_diameter_mm},
      {"entry_mm", record::list_of(run.info.entry_mm)},
      {"direction", record::list_of(run.info.direction)},
  };
  return record::compact(json);
}

}  // namespace stylet::results
