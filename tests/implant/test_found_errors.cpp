// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds that were found beside those that were simulated: parts of the errors, agreement, and the plan of their dose.
#include "stylet/implant/found_errors.hpp"
#include "stylet/implant/seed_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stylet {
namespace {

using Random = std::mt19937;

Vec3 normal_vector(Random& random, double sd) {
  std::normal_distribution<double> normal(0.0, sd);
  return {normal(random), normal(random), normal(random)};
}

/// Seeds in rows of needles, with errors by two causes.
ImplantHistory random_history(Random& random) {
  ImplantHistory history;
  for (std::size_t needle = 0; needle < 20; ++needle) {
    history.needles.emplace_back().name = "needle " + std::to_string(needle + 1);
    for (std::size_t k = 0; k < 4; ++k) {
      SeedHistory seed;
      seed.number = history.seeds.size();
      seed.needle = needle;
      seed.planned_mm = Vec3(10.0 * static_cast<double>(needle % 5), 10.0 * std::floor(static_cast<double>(needle) / 5),
                             10.0 * static_cast<double>(k));
      seed.by(SeedCause::bend) = normal_vector(random, 0.4);
      seed.by(SeedCause::motion) = normal_vector(random, 0.8) + Vec3(0, 0, 1.0);
      seed.dropped_mm = seed.planned_mm + seed.by(SeedCause::bend);
      seed.rest_mm = seed.dropped_mm + seed.by(SeedCause::motion);
      history.seeds.push_back(seed);
    }
  }
  return history;
}

/// The seeds at rest, found with a shift and an error of each.
std::vector<FoundSeed> found_near(const ImplantHistory& history, Random& random, const Vec3& shift, double sd) {
  std::vector<FoundSeed> found;
  for (const SeedHistory& seed : history.seeds)
    found.push_back({.at_mm = seed.rest_mm + shift + normal_vector(random, sd)});
  return found;
}

double sum_of_parts(const FoundErrors& errors) {
  double sum = 0.0;
  for (const ErrorPart& part : errors.parts) sum += part.mean_mm2;
  return sum;
}

const ErrorPart& part_of(const FoundErrors& errors, const std::string& name) {
  for (const ErrorPart& part : errors.parts) {
    if (part.name == name) return part;
  }
  static const ErrorPart none;
  return none;
}

}  // namespace

TEST(CompareFound, parts_of_the_mean_square_add_up_with_the_shift_and_without_it) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const ImplantHistory history = random_history(random);
    const auto found = found_near(history, random, normal_vector(random, 1.0), 0.7);
    const FoundComparison comparison = compare_found(history, found);
    ASSERT_GE(comparison.seeds.size(), 75U);
    for (const FoundErrors& errors : {comparison.as_found, comparison.without_shift}) {
      EXPECT_NEAR(sum_of_parts(errors), errors.mean_square_mm2, 1e-9);
      double percent = 0.0;
      for (const ErrorPart& part : errors.parts) percent += part.percent;
      EXPECT_NEAR(percent, 100.0, 1e-9);
    }
    EXPECT_EQ(comparison.as_found.parts.size(), causes_of(Implant::permanent).size() + 2);
    EXPECT_EQ(comparison.without_shift.parts.size(), causes_of(Implant::permanent).size() + 1);
    for (const auto& axis : comparison.without_shift.remainder.axes) EXPECT_NEAR(axis.mean_mm, 0.0, 1e-12);
    for (const MatchedSeed& matched : comparison.seeds) {
      Vec3 sum = matched.remainder_mm;
      for (const Vec3& cause : matched.seed.cause_mm) sum += cause;
      EXPECT_NEAR((sum - matched.error_mm()).norm(), 0.0, 1e-12);
    }
  }
}

TEST(CompareFound, a_simulation_that_is_right_explains_everything) {
  Random random(2);
  const ImplantHistory history = random_history(random);
  const FoundComparison comparison = compare_found(history, found_near(history, random, Vec3::Zero(), 0.0));
  EXPECT_NEAR(*comparison.all.correlation, 1.0, 1e-12);
  EXPECT_NEAR(*comparison.all.explained_percent, 100.0, 1e-9);
  EXPECT_NEAR(part_of(comparison.as_found, "not explained by the simulation").percent, 0.0, 1e-9);
  EXPECT_GT(part_of(comparison.as_found, "tissue motion").percent, 50.0);
  EXPECT_NEAR(comparison.as_found.error.mean_mm, seed_errors(history.seeds).mean_mm, 1e-12);
}

TEST(CompareFound, errors_of_half_the_variance_are_explained_by_half_and_a_shift_changes_nothing) {
  Random random(3);
  const ImplantHistory history = random_history(random);
  // Simulated errors have a variance of 0.8 mm² along each axis; the remainder has as much.
  const auto found = found_near(history, random, Vec3::Zero(), std::sqrt(0.8));
  const FoundComparison comparison = compare_found(history, found);
  EXPECT_NEAR(*comparison.all.explained_percent, 50.0, 12.0);
  EXPECT_NEAR(*comparison.all.correlation, std::sqrt(0.5), 0.12);
  EXPECT_NEAR(*comparison.correlation_by_chance, 1.96 / std::sqrt(79.0), 1e-12);
  std::vector<FoundSeed> moved = found;
  for (FoundSeed& seed : moved) seed.at_mm += Vec3(0.5, -1.0, 2.0);
  const FoundComparison other = compare_found(history, moved);
  ASSERT_EQ(other.seeds.size(), comparison.seeds.size());
  EXPECT_NEAR((other.matching.shift_mm - comparison.matching.shift_mm - Vec3(0.5, -1.0, 2.0)).norm(), 0.0, 1e-9);
  EXPECT_TRUE(other.matching.shift_beyond_chance());
  EXPECT_NEAR(*other.all.correlation, *comparison.all.correlation, 1e-9);
  EXPECT_NEAR(*other.axes[2].explained_percent, *comparison.axes[2].explained_percent, 1e-9);
  EXPECT_NEAR(other.without_shift.mean_square_mm2, comparison.without_shift.mean_square_mm2, 1e-9);
  EXPECT_GT(other.as_found.mean_square_mm2, other.without_shift.mean_square_mm2 + 2.0);
}

TEST(CompareFound, unrelated_errors_make_the_simulation_worse_than_none) {
  Random random(4);
  const ImplantHistory history = random_history(random);
  std::vector<FoundSeed> found;
  for (const SeedHistory& seed : history.seeds)
    found.push_back({.at_mm = seed.planned_mm + normal_vector(random, 0.6)});
  const FoundComparison comparison = compare_found(history, found);
  EXPECT_LT(*comparison.all.explained_percent, 0.0);
  EXPECT_LT(std::abs(*comparison.all.correlation), 0.25);
}

TEST(CompareFound, is_the_same_when_everything_is_moved_or_mirrored) {
  Random random(5);
  const ImplantHistory history = random_history(random);
  const auto found = found_near(history, random, Vec3(0.3, 0.2, -0.9), 0.8);
  const FoundComparison comparison = compare_found(history, found);
  for (const double side : {1.0, -1.0}) {
    const Vec3 mirror(side, 1.0, 1.0), move(120.0, -35.0, 80.0);
    ImplantHistory image = history;
    for (SeedHistory& seed : image.seeds) {
      for (Vec3* x : {&seed.planned_mm, &seed.dropped_mm, &seed.rest_mm}) *x = mirror.cwiseProduct(*x) + move;
      for (Vec3& cause : seed.cause_mm) cause = mirror.cwiseProduct(cause);
    }
    std::vector<FoundSeed> places = found;
    for (FoundSeed& seed : places) seed.at_mm = mirror.cwiseProduct(seed.at_mm) + move;
    const FoundComparison other = compare_found(image, places);
    EXPECT_NEAR(other.as_found.mean_square_mm2, comparison.as_found.mean_square_mm2, 1e-9);
    EXPECT_NEAR(*other.all.correlation, *comparison.all.correlation, 1e-9);
    EXPECT_NEAR(other.as_found.error.axes[0].mean_mm, side * comparison.as_found.error.axes[0].mean_mm, 1e-9);
    for (std::size_t k = 0; k < comparison.as_found.parts.size(); ++k)
      EXPECT_NEAR(other.as_found.parts[k].mean_mm2, comparison.as_found.parts[k].mean_mm2, 1e-9);
  }
}

TEST(CompareFound, does_not_match_seeds_that_the_simulation_has_lost_and_bears_few_seeds) {
  Random random(6);
  ImplantHistory history = random_history(random);
  history.seeds[0].lost = true;
  auto found = found_near(history, random, Vec3::Zero(), 0.1);
  FoundComparison comparison = compare_found(history, found);
  EXPECT_EQ(comparison.seeds.size(), 79U);
  EXPECT_EQ(comparison.seeds.front().seed.number, 1U);
  EXPECT_EQ(comparison.matching.pairs.front().dropped, 1U) << "positions are those of the history";
  EXPECT_EQ(comparison.matching.extra, (std::vector<std::size_t>{0}));
  found.resize(2);
  comparison = compare_found(history, found);
  EXPECT_FALSE(comparison.all.correlation || comparison.all.explained_percent || comparison.correlation_by_chance);
  found.clear();
  comparison = compare_found(history, found);
  EXPECT_TRUE(comparison.seeds.empty());
  EXPECT_EQ(comparison.as_found.mean_square_mm2, 0.0);
  EXPECT_EQ(comparison.matching.not_found.size(), 79U);
}

TEST(FoundPlan, has_every_seed_that_was_found_with_strength_and_axis) {
  Random random(7);
  const ImplantHistory history = random_history(random);
  DosePlan plan;
  plan.prescription_Gy = 145.0;
  for (const SeedHistory& seed : history.seeds)
    plan.sources.push_back({.at_mm = seed.planned_mm, .strength_U = seed.number == 0 ? 0.9 : 0.5});
  auto found = found_near(history, random, Vec3(0, 0, 1), 0.0);
  std::swap(found[0], found[5]);
  found[1].axis = Vec3(0.6, 0.0, 0.8);
  found.push_back({.at_mm = Vec3(0, 0, 200)});
  const FoundComparison comparison = compare_found(history, found);
  const DosePlan out = found_plan(plan, history, found, comparison, comparison.matching.shift_mm);
  ASSERT_EQ(out.sources.size(), 81U);
  EXPECT_EQ(out.prescription_Gy, 145.0);
  EXPECT_EQ(out.sources[5].strength_U, 0.9) << "of its planned seed";
  EXPECT_EQ(out.sources[5].needle, "needle 1");
  EXPECT_NEAR((out.sources[5].at_mm - history.seeds[0].rest_mm).norm(), 0.0, 1e-9);
  EXPECT_EQ(out.sources[1].axis, Vec3(0.6, 0.0, 0.8));
  EXPECT_TRUE(out.sources[2].has_axis);
  EXPECT_NEAR(out.sources[80].strength_U, (0.9 + 79 * 0.5) / 80.0, 1e-12);
  EXPECT_FALSE(out.sources[80].has_axis);
  EXPECT_EQ(out.sources[80].needle, "");
}

}  // namespace stylet
