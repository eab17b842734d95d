// SPDX-License-Identifier: GPL-3.0-or-later
// A plan of 44 seeds whose dose an independent calculator has computed. The data are not part of the repository;
// without them the tests are skipped.
#include "stylet/dose/dose_volume.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/rate_table.hpp"
#include "stylet/dose/structure_samples.hpp"
#include "stylet/dose/tg43.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

namespace stylet {
namespace {

namespace fs = std::filesystem;

class SyntheticPlan : public testing::Test {
 protected:
  void SetUp() override {
    const char* chosen = std::getenv("STYLET_SHARED_DATA");
    const fs::path file =
        fs::path(chosen != nullptr ? chosen : STYLET_SHARED_DATA_DEFAULT) / "dose_synthetic/expected_synthetic.json";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    plan = nlohmann::json::parse(std::ifstream(file));
    for (const auto& at : plan.at("seeds_xyz_mm"))
      seeds.push_back({.at_mm = Vec3(at[0], at[1], at[2]), .axis = Vec3::UnitZ(), .weight = plan.at("S_K_U")});
  }

  /// Largest relative difference from the expected dose at all points that are further than `least` [mm] from all
  /// seeds.
  [[nodiscard]] double worst(DoseFormalism formalism, const char* key, double least) const {
    const Tg43 tg43 = Tg43::create(find_source(plan.at("source")).value(), formalism).value();
    double found = 0.0;
    int compared = 0;
    for (const auto& point : plan.at("points")) {
      const auto& at = point.at("xyz_mm");
      const Vec3 x(at[0], at[1], at[2]);
      const bool near = std::any_of(seeds.begin(), seeds.end(),
                                    [&](const PlacedSource& seed) { return (x - seed.at_mm).norm() < least; });
      if (near) continue;
      double rate = 0.0;
      sum_rates(tg43, seeds, {&x, 1}, {&rate, 1});
      const double expected = point.at(key);
      found = std::max(found, std::abs(rate * permanent_Gy_per_rate(59.4) / expected - 1.0));
      ++compared;
    }
    EXPECT_GT(compared, 20);
    return found;
  }

  nlohmann::json plan;
  std::vector<PlacedSource> seeds;
};

TEST_F(SyntheticPlan, has_the_dose_of_an_independent_calculator_by_the_line_source) {
  EXPECT_LT(worst(DoseFormalism::line2d, "2d", 2.5), 5e-4);
  EXPECT_LT(worst(DoseFormalism::line2d, "2d", 2.0), 5e-3);
}

TEST_F(SyntheticPlan, has_it_without_directions_as_well) {
  EXPECT_LT(worst(DoseFormalism::line1d, "1d_line", 2.5), 5e-4);
}

/// The ellipsoid of the plan, drawn on planes 1 mm apart.
Roi ellipsoid(const Vec3& half) {
  Roi roi;
  roi.name = "prostate";
  const double last = std::floor(half.z() - 0.5) + 0.5;
  for (double z = -last; z <= last; z += 1.0) {
    const double scale = std::sqrt(1.0 - z * z / (half.z() * half.z()));
    Contour contour;
    for (int k = 0; k < 240; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 240;
      contour.points.emplace_back(scale * half.x() * std::cos(angle), scale * half.y() * std::sin(angle), z);
    }
    roi.contours.push_back(contour);
  }
  return roi;
}

// Sampled every 0.5 mm.
TEST_F(SyntheticPlan, has_the_dose_volume_figures_of_an_independent_calculator) {
  const auto& axes = plan.at("ellipsoid_semi_axes_mm");
  const StructureSamples samples = sample_structure(ellipsoid(Vec3(axes[0], axes[1], axes[2])), 0.5).value();
  const Tg43 tg43 = Tg43::create(find_source(plan.at("source")).value(), DoseFormalism::line2d).value();
  std::vector<double> dose(samples.points.size());
  sum_rates(tg43, seeds, samples.points, dose);
  for (double& d : dose) d *= permanent_Gy_per_rate(59.4);
  const DoseVolume dvh(dose, samples.volume_mm3);
  const auto& expected = plan.at("structures").at("prostate_0.5mm").at("2d");
  EXPECT_NEAR(dvh.volume_cc() / expected.at("volume_cc").get<double>(), 1.0, 0.003);
  EXPECT_NEAR(dvh.dose_of_percent(90.0) / expected.at("D90_Gy").get<double>(), 1.0, 0.003);
  EXPECT_NEAR(dvh.dose_of_percent(50.0) / expected.at("D50_Gy").get<double>(), 1.0, 0.003);
  EXPECT_NEAR(dvh.percent_above(145.0), expected.at("V100_pct").get<double>(), 0.3);
  EXPECT_NEAR(dvh.percent_above(1.5 * 145.0), expected.at("V150_pct").get<double>(), 0.3);
  EXPECT_NEAR(dvh.percent_above(2.0 * 145.0), expected.at("V200_pct").get<double>(), 0.3);
}

// Seeds that land beside their places at random, as D90 over that of the plan: means of 200 draws.
TEST_F(SyntheticPlan, loses_D90_with_random_errors_of_placement_as_an_independent_calculator_says) {
  const auto& axes = plan.at("ellipsoid_semi_axes_mm");
  const StructureSamples samples = sample_structure(ellipsoid(Vec3(axes[0], axes[1], axes[2])), 1.5).value();
  const RateTable table(Tg43::create(find_source(plan.at("source")).value(), DoseFormalism::line1d).value());
  std::vector<double> dose(samples.points.size());
  const auto D90 = [&](const std::vector<PlacedSource>& placed) {
    sum_rates(table, placed, samples.points, dose);
    return DoseVolume(dose, samples.volume_mm3).dose_of_percent(90.0);
  };
  const double planned = D90(seeds);
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  int compared = 0;
  for (const auto& [name, expected] : plan.at("placement_error_to_D90").items()) {
    if (!expected.contains("sigma_xyz_mm")) continue;
    const auto& sigma = expected.at("sigma_xyz_mm");
    constexpr int draws = 200;
    double sum = 0.0;
    for (int draw = 0; draw < draws; ++draw) {
      std::vector<PlacedSource> placed = seeds;
      for (PlacedSource& seed : placed) {
        for (int axis = 0; axis < 3; ++axis)
          seed.at_mm[axis] += sigma[static_cast<std::size_t>(axis)].get<double>() * normal(random);
      }
      sum += D90(placed) / planned;
    }
    EXPECT_NEAR(sum / draws, expected.at("D90_ratio_mean").get<double>(), 0.01) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 8);
}

TEST_F(SyntheticPlan, one_seed_without_direction_has_its_isodose_where_it_was_computed) {
  const Tg43 tg43 = Tg43::create(find_source(plan.at("source")).value(), DoseFormalism::line1d).value();
  const double dose = permanent_Gy_per_rate(59.4) * plan.at("S_K_U").get<double>();
  const auto& checks = plan.at("closed_form_checks");
  const double r = checks.at("one_seed_1d_isodose145_radius_mm");
  EXPECT_NEAR(dose * tg43.rate(r, 0.0) / 145.0, 1.0, 1e-6);
  const Tg43 line = Tg43::create(find_source(plan.at("source")).value(), DoseFormalism::line2d).value();
  EXPECT_NEAR(
      permanent_Gy_per_rate(59.4) * line.rate(10.0, 0.0) / checks.at("total_dose_Gy_per_U_at_1cm_90").get<double>(),
      1.0, 1e-9);
}

}  // namespace
}  // namespace stylet
