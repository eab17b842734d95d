// SPDX-License-Identifier: GPL-3.0-or-later
// The dose that the live page shows, against that of stylet dose.
#include "implant_dose.hpp"
#include "small_implant.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

using namespace stylet;
using namespace stylet::serve;
using namespace stylet::test;

namespace {

std::vector<PlacedSource> placed(const DosePlan& plan, std::size_t count) {
  std::vector<PlacedSource> seeds;
  for (std::size_t k = 0; k < count; ++k)
    seeds.push_back({plan.sources[k].at_mm, plan.sources[k].axis, plan.sources[k].strength_U});
  return seeds;
}

/// Waits for the goals of the seeds that were set last.
ImplantDose::News complete(ImplantDose& dose, std::uint64_t version) {
  ImplantDose::News all;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < end) {
    ImplantDose::News news = dose.news();
    if (news.planned) all.planned = news.planned;
    if (news.grid) all.grid = news.grid;
    if (news.now) {
      all.now = news.now;
      all.version = news.version;
    }
    if (all.now && all.version == version && !all.now->goals.empty()) return all;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ADD_FAILURE() << "the dose was not computed";
  return all;
}

std::unique_ptr<ImplantDose> opened(std::shared_ptr<const ImplantCase> implant) {
  return value_of(ImplantDose::open(std::move(implant)));
}

}  // namespace

TEST(ImplantDose, of_all_seeds_is_that_of_stylet_dose_within_half_a_percent) {
  const auto implant = std::make_shared<ImplantCase>(*small_implant(0.5));
  implant->options.grid_step_mm = 5.0;  // the grid is not looked at
  ASSERT_GT(implant->structures[0].samples.points.size(), 3 * ImplantDose::kMostSamples) << "samples are left out";
  const auto dose = opened(implant);
  const auto news = complete(*dose, dose->set(placed(implant->plan, 5)));
  const auto expected = evaluate_dose(implant->plan, implant->source, implant->structures, implant->options);
  ASSERT_TRUE(expected);
  const DoseVolume& dvh = expected->structures[0].dvh;
  EXPECT_NEAR(news.now->d90_Gy, dvh.dose_of_percent(90.0), 0.005 * dvh.dose_of_percent(90.0));
  EXPECT_NEAR(news.now->v100_percent, dvh.percent_above(20.0), 0.5);
  ASSERT_EQ(news.now->goals.size(), expected->goals.size());
  for (std::size_t k = 0; k < expected->goals.size(); ++k) {
    ASSERT_EQ(news.now->goals[k].value.has_value(), expected->goals[k].value.has_value());
    if (expected->goals[k].value) {
      EXPECT_NEAR(*news.now->goals[k].value, *expected->goals[k].value,
                  0.01 * std::max(100.0, *expected->goals[k].value));
    }
  }
  // The planned dose is without swelling.
  DoseOptions unswollen = implant->options;
  unswollen.swelling = {};
  const auto planned = evaluate_dose(implant->plan, implant->source, implant->structures, unswollen);
  ASSERT_TRUE(planned);
  const double d90 = planned->structures[0].dvh.dose_of_percent(90.0);
  EXPECT_NEAR(news.planned->d90_Gy, d90, 0.005 * d90);
  EXPECT_GT(d90, 1.02 * news.now->d90_Gy);
}

TEST(ImplantDose, a_seed_taken_back_leaves_the_dose_as_it_was) {
  const auto implant = small_implant();
  const auto dose = opened(implant);
  const auto before = complete(*dose, dose->set(placed(implant->plan, 3)));
  const auto more = complete(*dose, dose->set(placed(implant->plan, 4)));
  const auto after = complete(*dose, dose->set(placed(implant->plan, 3)));
  EXPECT_GT(more.now->d90_Gy, before.now->d90_Gy);
  EXPECT_NEAR(after.now->d90_Gy, before.now->d90_Gy, 1e-9);
  const auto none = complete(*dose, dose->set({}));
  EXPECT_EQ(none.now->d90_Gy, 0.0);
  EXPECT_EQ(none.now->v100_percent, 0.0);
}

TEST(ImplantDose, the_grid_has_the_dose_in_percent_of_the_prescribed_dose) {
  auto implant = std::make_shared<ImplantCase>(*small_implant());
  implant->options.swelling = {};
  implant->options.grid_step_mm = 5.0;
  const auto dose = opened(implant);
  const auto news = complete(*dose, dose->set(placed(implant->plan, 5)));
  ASSERT_TRUE(news.grid);
  const LiveDose& grid = *news.grid;
  ASSERT_EQ(grid.values.size(), std::size_t{grid.size[0]} * grid.size[1] * grid.size[2]);
  DoseOptions options = implant->options;
  std::vector<double> shown;
  for (std::uint32_t k = 3; k < grid.size[2]; k += 7) {
    const std::array<std::uint32_t, 3> at{k % grid.size[0], grid.size[1] / 2, k};
    options.points.push_back(grid.origin_mm + grid.spacing_mm * Vec3(at[0], at[1], at[2]));
    shown.push_back(grid.unit_percent * grid.values[at[0] + grid.size[0] * (at[1] + grid.size[1] * at[2])]);
  }
  const auto expected = evaluate_dose(implant->plan, implant->source, implant->structures, options);
  ASSERT_TRUE(expected);
  const double largest = 65535 * grid.unit_percent;  // stands for all larger doses
  for (std::size_t k = 0; k < shown.size(); ++k)
    EXPECT_NEAR(shown[k], std::min(5.0 * expected->point_Gy[k], largest), 0.1 + 0.002 * shown[k]) << "percent of 20 Gy";
}

TEST(ImplantDose, needs_a_target) {
  auto implant = std::make_shared<ImplantCase>(*small_implant());
  implant->structures[0].region = "bladder";
  const auto dose = ImplantDose::open(implant);
  ASSERT_FALSE(dose.ok());
  EXPECT_NE(dose.error().message().find("no target"), std::string::npos) << dose.error().message();
}
