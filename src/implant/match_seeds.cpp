// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/match_seeds.hpp"

#include "assignment.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// Each round lowers the sum of costs, so the rounds end by themselves; this only bounds them.
constexpr int kMostRounds = 100;
/// Two-sided normal quantile for 5 % over three axes: 1 − 0.05/6 = Φ(2.394).
constexpr double kBeyondChance = 2.394;
/// Odds of a match that is 95 % sure.
constexpr double kSureOdds = 19.0;

double squared(double x) { return x * x; }

/// The pairs with the least sum of squared distances after a shift.
std::vector<SeedPair> pairs_after(const Vec3& shift, std::span<const Vec3> dropped, std::span<const Vec3> found) {
  const bool turned = dropped.size() > found.size();  // rows are the shorter list
  const std::span<const Vec3> rows = turned ? found : dropped, columns = turned ? dropped : found;
  MatX cost(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double distance = ((turned ? rows[r] - columns[c] : columns[c] - rows[r]) - shift).squaredNorm();
      // A pair at the limit costs as much as two seeds that are left alone, so no pair costs more.
      cost(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = std::min(distance, squared(kMatchLimit_mm));
    }
  }
  std::vector<SeedPair> pairs;
  if (rows.empty()) return pairs;
  const std::vector<Index> column_of = cheapest_assignment(cost);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto c = static_cast<std::size_t>(column_of[r]);
    if (cost(static_cast<Eigen::Index>(r), column_of[r]) >= squared(kMatchLimit_mm)) continue;
    pairs.push_back(turned ? SeedPair{.dropped = c, .found = r} : SeedPair{.dropped = r, .found = c});
  }
  std::sort(pairs.begin(), pairs.end(), [](const SeedPair& a, const SeedPair& b) { return a.dropped < b.dropped; });
  return pairs;
}

bool same_pairs(const std::vector<SeedPair>& a, const std::vector<SeedPair>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SeedPair& x, const SeedPair& y) { return x.dropped == y.dropped && x.found == y.found; });
}

Vec3 mean_shift_of(const std::vector<SeedPair>& pairs, std::span<const Vec3> dropped, std::span<const Vec3> found) {
  Vec3 sum = Vec3::Zero();
  for (const SeedPair& pair : pairs) sum += found[pair.found] - dropped[pair.dropped];
  return pairs.empty() ? sum : Vec3(sum / static_cast<double>(pairs.size()));
}

/// Matching and common shift in turn, until the matching stays.
std::vector<SeedPair> pairs_from(Vec3 shift, std::span<const Vec3> dropped, std::span<const Vec3> found) {
  std::vector<SeedPair> pairs = pairs_after(shift, dropped, found);
  for (int round = 0; round < kMostRounds; ++round) {
    shift = mean_shift_of(pairs, dropped, found);
    std::vector<SeedPair> next = pairs_after(shift, dropped, found);
    const bool stays = same_pairs(pairs, next);
    pairs = std::move(next);
    if (stays) break;
  }
  return pairs;
}

Vec3 centre_of_seeds(std::span<const Vec3> places) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : places) sum += x;
  return sum / static_cast<double>(places.size());
}

std::vector<std::size_t> left_alone(std::size_t count, const std::vector<SeedPair>& pairs,
                                    std::size_t SeedPair::*which) {
  std::vector<char> taken(count, 0);
  for (const SeedPair& pair : pairs) taken[pair.*which] = 1;
  std::vector<std::size_t> alone;
  for (std::size_t k = 0; k < count; ++k) {
    if (taken[k] == 0) alone.push_back(k);
  }
  return alone;
}

/// Marks the pairs beside which another match is nearly as likely.
void mark_ambiguous(SeedMatching& matching, std::span<const Vec3> dropped, std::span<const Vec3> found) {
  const double nearly = 2.0 * squared(matching.scatter_mm) * std::log(kSureOdds);
  const auto cost = [&](std::size_t d, std::size_t f) {
    return (found[f] - dropped[d] - matching.shift_mm).squaredNorm();
  };
  for (SeedPair& pair : matching.pairs) {
    const double own = cost(pair.dropped, pair.found);
    const auto nearly_as_good = [&](double with, double without) { return with - without <= nearly; };
    for (const std::size_t f : matching.extra) pair.ambiguous |= nearly_as_good(cost(pair.dropped, f), own);
    for (const std::size_t d : matching.not_found) pair.ambiguous |= nearly_as_good(cost(d, pair.found), own);
    for (const SeedPair& other : matching.pairs) {
      if (&other == &pair) continue;
      pair.ambiguous |= nearly_as_good(cost(pair.dropped, other.found) + cost(other.dropped, pair.found),
                                       own + cost(other.dropped, other.found));
    }
  }
}

}  // namespace

bool SeedMatching::shift_beyond_chance() const {
  if (pairs.size() < 2) return false;
  return (shift_mm.cwiseAbs().array() > kBeyondChance * shift_error_mm.array()).any();
}

SeedMatching match_seeds(std::span<const Vec3> dropped, std::span<const Vec3> found) {
  SeedMatching matching;
  matching.pairs = pairs_from(Vec3::Zero(), dropped, found);
  const std::size_t fewer = std::min(dropped.size(), found.size()), more = std::max(dropped.size(), found.size());
  // A few seeds would match anywhere, so only a whole implant is moved.
  if (2 * matching.pairs.size() < fewer && 2 * fewer >= more) {
    std::vector<SeedPair> moved = pairs_from(centre_of_seeds(found) - centre_of_seeds(dropped), dropped, found);
    matching.frame_moved = moved.size() > matching.pairs.size();
    if (matching.frame_moved) matching.pairs = std::move(moved);
  }
  matching.not_found = left_alone(dropped.size(), matching.pairs, &SeedPair::dropped);
  matching.extra = left_alone(found.size(), matching.pairs, &SeedPair::found);
  matching.shift_mm = mean_shift_of(matching.pairs, dropped, found);
  if (matching.pairs.size() < 2) return matching;
  Vec3 squares = Vec3::Zero();
  for (const SeedPair& pair : matching.pairs) {
    const Vec3 off = found[pair.found] - dropped[pair.dropped] - matching.shift_mm;
    squares += off.cwiseProduct(off);
  }
  const auto count = static_cast<double>(matching.pairs.size());
  const Vec3 variance = squares / (count - 1.0);
  matching.shift_error_mm = (variance / count).cwiseSqrt();
  matching.scatter_mm = std::sqrt(variance.mean());
  mark_ambiguous(matching, dropped, found);
  return matching;
}

}  // namespace stylet
