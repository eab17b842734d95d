// SPDX-License-Identifier: GPL-3.0-or-later
// Which seeds that were found are which seeds that were dropped: random situations with a known answer.
#include "stylet/implant/match_seeds.hpp"

#include "implant/assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <random>

namespace stylet {
namespace {

using Random = std::mt19937;

double number_between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3 vector_within(Random& random, double half_width) {
  return {number_between(random, -half_width, half_width), number_between(random, -half_width, half_width),
          number_between(random, -half_width, half_width)};
}

/// Places in a gland that are further from each other than a distance.
std::vector<Vec3> places_apart(Random& random, std::size_t count, double apart_mm) {
  std::vector<Vec3> places;
  while (places.size() < count) {
    const Vec3 x = vector_within(random, 25.0);
    if (std::all_of(places.begin(), places.end(), [&](const Vec3& y) { return (x - y).norm() > apart_mm; }))
      places.push_back(x);
  }
  return places;
}

std::vector<std::size_t> shuffled(Random& random, std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// The seed found for each seed that was dropped; −1: none.
std::vector<int> found_of(const SeedMatching& matching, std::size_t dropped) {
  std::vector<int> found(dropped, -1);
  for (const SeedPair& pair : matching.pairs) found[pair.dropped] = static_cast<int>(pair.found);
  return found;
}

double sum_of(const MatX& cost, const std::vector<Index>& column_of) {
  double sum = 0.0;
  for (Eigen::Index row = 0; row < cost.rows(); ++row) sum += cost(row, column_of[static_cast<std::size_t>(row)]);
  return sum;
}

/// The least sum of all assignments, tried one by one.
double least_sum(const MatX& cost) {
  std::vector<Index> columns(static_cast<std::size_t>(cost.cols()));
  std::iota(columns.begin(), columns.end(), 0);
  double least = sum_of(cost, columns);
  while (std::next_permutation(columns.begin(), columns.end())) least = std::min(least, sum_of(cost, columns));
  return least;
}

}  // namespace

TEST(CheapestAssignment, costs_as_little_as_the_best_of_all_assignments) {
  Random random(1);
  for (int round = 0; round < 300; ++round) {
    const Eigen::Index columns = 1 + round % 7, rows = 1 + (round / 7) % columns;
    MatX cost(rows, columns);
    for (double& value : cost.reshaped()) {
      value = number_between(random, -5.0, 20.0);
      if (round % 3 == 0) value = std::round(value / 5.0);  // many assignments cost the same
    }
    const std::vector<Index> column_of = cheapest_assignment(cost);
    std::vector<Index> sorted = column_of;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end()) << "each column once";
    EXPECT_GE(sorted.front(), 0);
    EXPECT_NEAR(sum_of(cost, column_of), least_sum(cost), 1e-9) << round;
  }
}

TEST(CheapestAssignment, takes_no_second_for_two_hundred_seeds) {
  Random random(2);
  MatX cost(200, 200);
  for (double& value : cost.reshaped()) value = number_between(random, 0.0, 100.0);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(cheapest_assignment(cost).size(), 200U);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 1.0);
}

TEST(MatchSeeds, finds_the_permutation_under_small_errors) {
  Random random(3);
  for (int round = 0; round < 40; ++round) {
    const std::size_t count = 3 + static_cast<std::size_t>(round);
    const std::vector<Vec3> dropped = places_apart(random, count, 6.0);
    const std::vector<std::size_t> order = shuffled(random, count);
    std::vector<Vec3> found(count);
    for (std::size_t k = 0; k < count; ++k) found[order[k]] = dropped[k] + vector_within(random, 0.5);
    const SeedMatching matching = match_seeds(dropped, found);
    EXPECT_TRUE(std::equal(order.begin(), order.end(), found_of(matching, count).begin(),
                           [](std::size_t a, int b) { return static_cast<int>(a) == b; }));
    EXPECT_TRUE(matching.not_found.empty() && matching.extra.empty());
    EXPECT_FALSE(matching.frame_moved);
    EXPECT_TRUE(std::none_of(matching.pairs.begin(), matching.pairs.end(),
                             [](const SeedPair& pair) { return pair.ambiguous; }));
  }
}

TEST(MatchSeeds, matches_as_the_best_of_all_matchings_when_errors_are_large) {
  Random random(4);
  for (int round = 0; round < 60; ++round) {
    const std::size_t count = 2 + static_cast<std::size_t>(round % 6);
    std::vector<Vec3> dropped(count), found(count);
    for (std::size_t k = 0; k < count; ++k) {
      dropped[k] = vector_within(random, 8.0);
      found[k] = vector_within(random, 8.0);
    }
    const SeedMatching matching = match_seeds(dropped, found);
    const double limit = kMatchLimit_mm * kMatchLimit_mm;
    MatX cost(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
    for (std::size_t d = 0; d < count; ++d) {
      for (std::size_t f = 0; f < count; ++f) {
        cost(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(f)) =
            std::min(limit, (found[f] - dropped[d] - matching.shift_mm).squaredNorm());
      }
    }
    double sum = limit * static_cast<double>(count - matching.pairs.size());
    for (const SeedPair& pair : matching.pairs)
      sum += cost(static_cast<Eigen::Index>(pair.dropped), static_cast<Eigen::Index>(pair.found));
    EXPECT_NEAR(sum, least_sum(cost), 1e-9) << "at its own common shift no other matching is better";
  }
}

TEST(MatchSeeds, says_which_seeds_are_missing_and_which_were_never_dropped) {
  Random random(5);
  for (int round = 0; round < 40; ++round) {
    std::vector<Vec3> all = places_apart(random, 30, 6.0);
    std::vector<Vec3> dropped = all, found;
    const std::size_t lost = static_cast<std::size_t>(round) % 28;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (k != lost && k != lost + 1) found.emplace_back(all[k] + vector_within(random, 0.4));
    }
    found.emplace_back(0.0, 60.0, 0.0);
    const SeedMatching matching = match_seeds(dropped, found);
    EXPECT_EQ(matching.pairs.size(), 28U);
    EXPECT_EQ(matching.not_found, (std::vector<std::size_t>{lost, lost + 1}));
    EXPECT_EQ(matching.extra, (std::vector<std::size_t>{28}));
    // The other way round, the same pairs.
    const SeedMatching turned = match_seeds(found, dropped);
    EXPECT_EQ(turned.extra, matching.not_found);
    EXPECT_EQ(turned.not_found, matching.extra);
    EXPECT_NEAR((turned.shift_mm + matching.shift_mm).norm(), 0.0, 1e-12);
  }
}

TEST(MatchSeeds, finds_a_common_shift_and_does_not_let_it_exchange_seeds) {
  Random random(6);
  for (int round = 0; round < 40; ++round) {
    const std::vector<Vec3> dropped = places_apart(random, 60, 6.0);
    const std::vector<std::size_t> order = shuffled(random, dropped.size());
    const Vec3 shift = vector_within(random, 2.3);
    Vec3 mean = Vec3::Zero();
    std::vector<Vec3> found(dropped.size());
    for (std::size_t k = 0; k < dropped.size(); ++k) {
      const Vec3 error = shift + vector_within(random, 0.4);
      found[order[k]] = dropped[k] + error;
      mean += error / static_cast<double>(dropped.size());
    }
    const SeedMatching matching = match_seeds(dropped, found);
    EXPECT_NEAR((matching.shift_mm - mean).norm(), 0.0, 1e-9);
    EXPECT_TRUE(std::equal(order.begin(), order.end(), found_of(matching, order.size()).begin(),
                           [](std::size_t a, int b) { return static_cast<int>(a) == b; }));
    EXPECT_NEAR(matching.scatter_mm, 0.8 / std::sqrt(12.0), 0.05) << "of a uniform error";
    EXPECT_EQ(matching.shift_beyond_chance(), shift.cwiseAbs().maxCoeff() > 0.15) << shift.transpose();
  }
}

TEST(MatchSeeds, says_when_only_another_frame_lets_them_match) {
  Random random(7);
  const std::vector<Vec3> dropped = places_apart(random, 40, 6.0);
  std::vector<Vec3> found;
  for (const Vec3& x : dropped) found.emplace_back(x + Vec3(4.0, -90.0, 120.0));
  const SeedMatching matching = match_seeds(dropped, found);
  EXPECT_TRUE(matching.frame_moved);
  EXPECT_EQ(matching.pairs.size(), 40U);
  EXPECT_NEAR((matching.shift_mm - Vec3(4.0, -90.0, 120.0)).norm(), 0.0, 1e-9);
  // One seed would match anywhere.
  const SeedMatching alone = match_seeds(dropped, std::vector<Vec3>{dropped[3] + Vec3(0.0, -90.0, 0.0)});
  EXPECT_TRUE(alone.pairs.empty());
  EXPECT_EQ(alone.extra.size(), 1U);
  EXPECT_EQ(alone.not_found.size(), 40U);
}

TEST(MatchSeeds, a_pair_that_could_as_well_be_exchanged_is_ambiguous) {
  Random random(8);
  std::vector<Vec3> dropped = places_apart(random, 30, 8.0), found;
  for (const Vec3& x : dropped) found.emplace_back(x + vector_within(random, 0.5));
  EXPECT_FALSE(match_seeds(dropped, found).pairs[0].ambiguous);
  // Two seeds were dropped beside each other, and were found turned by a right angle.
  const Vec3 middle(0.0, 0.0, 60.0);
  dropped.emplace_back(middle + Vec3(1.0, 0.0, 0.0));
  dropped.emplace_back(middle - Vec3(1.0, 0.0, 0.0));
  found.emplace_back(middle + Vec3(0.02, 1.0, 0.0));
  found.emplace_back(middle - Vec3(0.02, 1.0, 0.0));
  const SeedMatching matching = match_seeds(dropped, found);
  EXPECT_EQ(std::count_if(matching.pairs.begin(), matching.pairs.end(), [](const SeedPair& p) { return p.ambiguous; }),
            2);
  EXPECT_TRUE(matching.pairs[30].ambiguous && matching.pairs[31].ambiguous);
}

TEST(MatchSeeds, gives_the_same_pairs_when_everything_is_moved_or_mirrored) {
  Random random(9);
  for (int round = 0; round < 30; ++round) {
    std::vector<Vec3> dropped = places_apart(random, 40, 4.0), found;
    for (const Vec3& x : dropped) found.emplace_back(x + Vec3(1.0, -0.5, 2.0) + vector_within(random, 3.0));
    found.resize(36);
    const SeedMatching matching = match_seeds(dropped, found);
    const Vec3 move = vector_within(random, 300.0);
    const Vec3 mirror(-1.0, 1.0, 1.0);
    for (const bool mirrored : {false, true}) {
      const auto image = [&](const Vec3& x) { return mirrored ? Vec3(mirror.cwiseProduct(x)) : Vec3(x + move); };
      std::vector<Vec3> d, f;
      for (const Vec3& x : dropped) d.push_back(image(x));
      for (const Vec3& x : found) f.push_back(image(x));
      const SeedMatching other = match_seeds(d, f);
      EXPECT_EQ(found_of(other, 40), found_of(matching, 40));
      EXPECT_EQ(other.extra, matching.extra);
      const Vec3 shift = mirrored ? Vec3(mirror.cwiseProduct(matching.shift_mm)) : matching.shift_mm;
      EXPECT_NEAR((other.shift_mm - shift).norm(), 0.0, 1e-9);
      EXPECT_NEAR(other.scatter_mm, matching.scatter_mm, 1e-9);
      for (std::size_t k = 0; k < other.pairs.size(); ++k)
        EXPECT_EQ(other.pairs[k].ambiguous, matching.pairs[k].ambiguous);
    }
  }
}

TEST(MatchSeeds, bears_lists_that_are_empty_or_have_one_seed) {
  const std::vector<Vec3> none, one{Vec3(1, 2, 3)}, near{Vec3(1, 2, 5)};
  EXPECT_TRUE(match_seeds(none, none).pairs.empty());
  EXPECT_EQ(match_seeds(none, one).extra.size(), 1U);
  EXPECT_EQ(match_seeds(one, none).not_found.size(), 1U);
  const SeedMatching matching = match_seeds(one, near);
  ASSERT_EQ(matching.pairs.size(), 1U);
  EXPECT_EQ(matching.shift_mm, Vec3(0, 0, 2));
  EXPECT_EQ(matching.scatter_mm, 0.0);
  EXPECT_FALSE(matching.shift_beyond_chance());
}

}  // namespace stylet
