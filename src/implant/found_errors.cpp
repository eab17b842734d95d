// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/found_errors.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// The errors of places that are not those of rest.
SeedErrors errors_from(const std::vector<Vec3>& errors) {
  std::vector<SeedHistory> seeds(errors.size());
  for (std::size_t k = 0; k < errors.size(); ++k) seeds[k].rest_mm = errors[k];
  return seed_errors(seeds);
}

/// @param taken_away the common shift, where it does not count as error
/// @param shift the common shift that counts as a part of its own; 0 where it is taken away
FoundErrors split_errors(const std::vector<MatchedSeed>& seeds, const Vec3& taken_away, const Vec3& shift) {
  FoundErrors out;
  std::vector<Vec3> errors, remainders;
  for (const MatchedSeed& matched : seeds) {
    errors.emplace_back(matched.error_mm() - taken_away);
    remainders.emplace_back(matched.remainder_mm - taken_away);
  }
  out.error = errors_from(errors);
  out.remainder = errors_from(remainders);
  const auto mean_product = [&](const auto& part_of) {
    double sum = 0.0;
    for (std::size_t k = 0; k < seeds.size(); ++k) sum += errors[k].dot(part_of(k));
    return seeds.empty() ? 0.0 : sum / static_cast<double>(seeds.size());
  };
  out.mean_square_mm2 = mean_product([&](std::size_t k) { return errors[k]; });
  const auto add = [&](const char* name, double mm2) {
    out.parts.push_back({name, mm2, out.mean_square_mm2 > 0.0 ? 100.0 * mm2 / out.mean_square_mm2 : 0.0});
  };
  for (const SeedCause cause : causes_of(Implant::permanent))
    add(to_string(cause), mean_product([&](std::size_t k) { return seeds[k].seed.by(cause); }));
  if (!shift.isZero(0.0)) add("common shift", mean_product([&](std::size_t) { return shift; }));
  add("not explained by the simulation", mean_product([&](std::size_t k) { return Vec3(remainders[k] - shift); }));
  return out;
}

/// Sums over seeds of products of deviations from the mean.
struct Spread {
  double simulated = 0.0, found = 0.0, both = 0.0, remainder = 0.0;

  Spread& operator+=(const Spread& other) {
    simulated += other.simulated;
    found += other.found;
    both += other.both;
    remainder += other.remainder;
    return *this;
  }
};

Spread spread_along(const std::vector<MatchedSeed>& seeds, Eigen::Index axis) {
  double simulated = 0.0, found = 0.0;
  const auto count = static_cast<double>(seeds.size());
  for (const MatchedSeed& matched : seeds) {
    simulated += matched.seed.error_mm()[axis] / count;
    found += matched.error_mm()[axis] / count;
  }
  Spread sums;
  for (const MatchedSeed& matched : seeds) {
    const double s = matched.seed.error_mm()[axis] - simulated, f = matched.error_mm()[axis] - found;
    sums += {.simulated = s * s, .found = f * f, .both = s * f, .remainder = (f - s) * (f - s)};
  }
  return sums;
}

Agreement agreement_of(const Spread& sums, std::size_t seeds) {
  constexpr double kEqual_mm2 = 1e-12;  // differences by rounding alone
  Agreement out;
  if (seeds < 3 || sums.found <= kEqual_mm2) return out;
  out.explained_percent = 100.0 * (1.0 - sums.remainder / sums.found);
  if (sums.simulated > kEqual_mm2) out.correlation = sums.both / std::sqrt(sums.simulated * sums.found);
  return out;
}

}  // namespace

FoundComparison compare_found(const ImplantHistory& history, const std::vector<FoundSeed>& found) {
  std::vector<std::size_t> numbers;  // of the seeds that the simulation has not lost
  std::vector<Vec3> at_rest, places;
  for (std::size_t k = 0; k < history.seeds.size(); ++k) {
    if (history.seeds[k].lost) continue;
    numbers.push_back(k);
    at_rest.push_back(history.seeds[k].rest_mm);
  }
  for (const FoundSeed& seed : found) places.push_back(seed.at_mm);
  FoundComparison out;
  out.matching = match_seeds(at_rest, places);
  for (SeedPair& pair : out.matching.pairs) pair.dropped = numbers[pair.dropped];
  for (std::size_t& dropped : out.matching.not_found) dropped = numbers[dropped];
  for (const SeedPair& pair : out.matching.pairs) {
    const SeedHistory& seed = history.seeds[pair.dropped];
    const Vec3& at = found[pair.found].at_mm;
    out.seeds.push_back({.seed = seed,
                         .found = pair.found,
                         .found_mm = at,
                         .remainder_mm = at - seed.rest_mm,
                         .ambiguous = pair.ambiguous});
  }
  out.as_found = split_errors(out.seeds, Vec3::Zero(), out.matching.shift_mm);
  out.without_shift = split_errors(out.seeds, out.matching.shift_mm, Vec3::Zero());
  Spread all;
  for (std::size_t axis = 0; axis < out.axes.size(); ++axis) {
    const Spread along = spread_along(out.seeds, static_cast<Eigen::Index>(axis));
    out.axes[axis] = agreement_of(along, out.seeds.size());
    all += along;
  }
  out.all = agreement_of(all, out.seeds.size());
  // Large samples: the correlation of unrelated errors is normal with the variance 1/(n − 1); 1.96 is the two-sided
  // normal quantile for 5 %.
  if (out.seeds.size() >= 3)
    out.correlation_by_chance = std::min(1.0, 1.96 / std::sqrt(static_cast<double>(out.seeds.size()) - 1.0));
  return out;
}

DosePlan found_plan(const DosePlan& plan, const ImplantHistory& history, const std::vector<FoundSeed>& found,
                    const FoundComparison& comparison, const Vec3& shift_mm) {
  DosePlan out = plan;
  out.label = plan.label.empty() ? "found on imaging" : plan.label + ", found on imaging";
  out.sources.clear();
  double strength = 0.0;
  for (const PlannedSource& source : plan.sources) strength += source.strength_U;
  for (const FoundSeed& seed : found) {
    PlannedSource source;
    source.at_mm = seed.at_mm - shift_mm;
    source.strength_U = strength / static_cast<double>(plan.sources.size());
    if (seed.axis) {
      source.axis = *seed.axis;
      source.has_axis = true;
    }
    out.sources.push_back(source);
  }
  for (const MatchedSeed& matched : comparison.seeds) {
    PlannedSource& source = out.sources[matched.found];
    source.strength_U = plan.sources[matched.seed.number].strength_U;
    source.needle = history.needles[matched.seed.needle].name;
    if (!source.has_axis) source.axis = matched.seed.axis;
    source.has_axis = true;
  }
  return out;
}

}  // namespace stylet
