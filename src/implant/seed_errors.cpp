// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/seed_errors.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

SeedErrors seed_errors(std::span<const SeedHistory> seeds) {
  SeedErrors out;
  std::vector<double> distances;
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  for (const SeedHistory& seed : seeds) {
    if (seed.lost) continue;
    const Vec3 error = seed.error_mm();
    distances.push_back(error.norm());
    sum += error;
    squares += error.cwiseProduct(error);
  }
  out.seeds = distances.size();
  if (distances.empty()) return out;
  std::sort(distances.begin(), distances.end());
  const auto count = static_cast<double>(distances.size());
  for (const double d : distances) out.mean_mm += d / count;
  const double rank = 0.95 * (count - 1.0);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, distances.size() - 1);
  out.p95_mm = distances[below] + (rank - static_cast<double>(below)) * (distances[above] - distances[below]);
  out.largest_mm = distances.back();
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = sum[axis] / count;
    const double variance = count > 1.0 ? (squares[axis] - count * mean * mean) / (count - 1.0) : 0.0;
    out.axes[static_cast<std::size_t>(axis)] = {mean, std::sqrt(std::max(0.0, variance))};
  }
  return out;
}

std::vector<PartErrors> errors_by_needle(const ImplantHistory& history) {
  std::vector<PartErrors> parts;
  for (std::size_t k = 0; k < history.needles.size(); ++k) {
    std::vector<SeedHistory> of_needle;
    for (const SeedHistory& seed : history.seeds) {
      if (seed.needle == k) of_needle.push_back(seed);
    }
    parts.push_back({history.needles[k].name, seed_errors(of_needle)});
  }
  return parts;
}

std::vector<std::size_t> thirds_of(const ImplantHistory& history) {
  double low = INFINITY, high = -INFINITY;
  for (const SeedHistory& seed : history.seeds) {
    low = std::min(low, seed.planned_mm.z());
    high = std::max(high, seed.planned_mm.z());
  }
  std::vector<std::size_t> thirds;
  for (const SeedHistory& seed : history.seeds) {
    const double from_base = high > low ? (high - seed.planned_mm.z()) / (high - low) : 0.5;
    thirds.push_back(static_cast<std::size_t>(std::min(2.0, std::floor(3.0 * from_base))));
  }
  return thirds;
}

std::vector<PartErrors> errors_by_third(const ImplantHistory& history) {
  const std::vector<std::size_t> third_of = thirds_of(history);
  std::array<std::vector<SeedHistory>, kThirds.size()> thirds;
  for (std::size_t k = 0; k < third_of.size(); ++k) thirds[third_of[k]].push_back(history.seeds[k]);
  std::vector<PartErrors> parts;
  for (std::size_t k = 0; k < thirds.size(); ++k) {
    if (!thirds[k].empty()) parts.push_back({kThirds[k], seed_errors(thirds[k])});
  }
  return parts;
}

std::vector<SeedCause> causes_of(Implant implant) {
  std::vector<SeedCause> causes;
  for (const SeedCauseWords& words : kSeedCauses)
    if (meaning_of(words.cause, implant) != nullptr) causes.push_back(words.cause);
  return causes;
}

ImplantHistory history_at_planning(const ImplantHistory& history) {
  ImplantHistory then = history;
  for (SeedHistory& dwell : then.seeds) {
    if (!dwell.at_planning) continue;
    dwell.dropped_mm = dwell.at_planning->room_mm;
    dwell.rest_mm = dwell.at_planning->tissue_mm;
    dwell.by(SeedCause::wait).setZero();
  }
  return then;
}

std::vector<CauseOfErrors> causes_of_errors(std::span<const SeedHistory> seeds) {
  std::vector<CauseOfErrors> causes;
  const auto count = static_cast<double>(
      std::count_if(seeds.begin(), seeds.end(), [](const SeedHistory& seed) { return !seed.lost; }));
  for (const SeedCause cause : causes_of(implant_of(seeds))) {
    CauseOfErrors of{.cause = cause};
    for (const SeedHistory& seed : seeds) {
      if (seed.lost) continue;
      of.mean_mm += seed.by(cause).norm() / count;
      of.mean_vector_mm += seed.by(cause) / count;
    }
    causes.push_back(of);
  }
  return causes;
}

DosePlan delivered_plan(const DosePlan& plan, const ImplantHistory& history) {
  DosePlan delivered = plan;
  delivered.label = plan.label.empty() ? "delivered" : plan.label + ", delivered";
  delivered.sources.clear();
  for (const SeedHistory& seed : history.seeds) {
    if (seed.lost) continue;
    PlannedSource source = plan.sources[seed.number];
    source.at_mm = seed.rest_mm;
    source.axis = seed.axis;
    source.has_axis = true;
    source.needle = history.needles[seed.needle].name;
    delivered.sources.push_back(source);
  }
  return delivered;
}

}  // namespace stylet
