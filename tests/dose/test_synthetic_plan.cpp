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
#include <string>
#include <utility>

namespace stylet {
namespace {

namespace fs = std::filesystem;

class SyntheticPlan : public testing::Test {
 protected:
  void SetUp() override {
    const char* chosen = std::getenv("STYLET_SHARED_DATA");
    data = fs::path(chosen != nullptr ? chosen : STYLET_SHARED_DATA_DEFAULT) / "dose_synthetic";
    const fs::path file = data / "expected_synthetic.json";
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

  fs::path data;
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

/// D90 over that of the plan when seeds land beside their places.
class Misplaced {
 public:
  /// @param step distance of the samples [mm]
  Misplaced(const nlohmann::json& plan, std::vector<PlacedSource> planned, double step)
      : samples_(sample_structure(ellipsoid(semi_axes(plan)), step).value()),
        table_(Tg43::create(find_source(plan.at("source")).value(), DoseFormalism::line1d).value()),
        seeds_(std::move(planned)),
        dose_(samples_.points.size()),
        planned_(D90(seeds_)) {}

  /// Mean of 200 draws with normally distributed errors. @param sigma standard deviations [mm]
  double random(const Vec3& sigma) {
    std::mt19937 engine(12);
    std::normal_distribution<double> normal;
    constexpr int draws = 200;
    double sum = 0.0;
    for (int draw = 0; draw < draws; ++draw) {
      std::vector<PlacedSource> placed = seeds_;
      for (PlacedSource& seed : placed) {
        for (int axis = 0; axis < 3; ++axis) seed.at_mm[axis] += sigma[axis] * normal(engine);
      }
      sum += D90(placed) / planned_;
    }
    return sum / draws;
  }

  /// All seeds beside their places by the same vector [mm].
  double shifted(const Vec3& by) {
    std::vector<PlacedSource> placed = seeds_;
    for (PlacedSource& seed : placed) seed.at_mm += by;
    return D90(placed) / planned_;
  }

 private:
  static Vec3 semi_axes(const nlohmann::json& plan) {
    const auto& axes = plan.at("ellipsoid_semi_axes_mm");
    return Vec3(axes[0], axes[1], axes[2]);
  }

  double D90(const std::vector<PlacedSource>& placed) {
    sum_rates(table_, placed, samples_.points, dose_);
    return DoseVolume(dose_, samples_.volume_mm3).dose_of_percent(90.0);
  }

  StructureSamples samples_;
  RateTable table_;
  std::vector<PlacedSource> seeds_;
  std::vector<double> dose_;
  double planned_;
};

TEST_F(SyntheticPlan, loses_D90_with_errors_of_placement_as_an_independent_calculator_says) {
  Misplaced misplaced(plan, seeds, 1.5);
  int compared = 0;
  for (const auto& [name, expected] : plan.at("placement_error_to_D90").items()) {
    if (!expected.contains("sigma_xyz_mm")) continue;
    const auto& sigma = expected.at("sigma_xyz_mm");
    EXPECT_NEAR(misplaced.random(Vec3(sigma[0], sigma[1], sigma[2])), expected.at("D90_ratio_mean").get<double>(), 0.01)
        << name;
    ++compared;
  }
  EXPECT_EQ(compared, 8);
  const auto& table = plan.at("placement_error_to_D90");
  EXPECT_NEAR(misplaced.shifted(Vec3(0, 0, 5)), table.at("shift_z_+5mm").at("D90_ratio").get<double>(), 0.01);
  EXPECT_NEAR(misplaced.shifted(Vec3(0, 0, -5)), table.at("shift_z_-5mm").at("D90_ratio").get<double>(), 0.01);
  EXPECT_NEAR(misplaced.shifted(Vec3(0, 0, 10)), table.at("shift_z_10mm").at("D90_ratio").get<double>(), 0.01);
  EXPECT_NEAR(misplaced.shifted(Vec3(0, 5, 0)), table.at("shift_y_5mm").at("D90_ratio").get<double>(), 0.01);
}

// A plan whose 92 seeds reach 3 mm beyond the gland.
TEST_F(SyntheticPlan, with_a_margin_loses_less_D90_by_shifts_and_as_much_by_random_errors) {
  const fs::path file = data / "margin_plan.json";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
  const auto margin = nlohmann::json::parse(std::ifstream(file));
  std::vector<PlacedSource> placed;
  for (const auto& at : margin.at("seeds"))
    placed.push_back({.at_mm = Vec3(at[0], at[1], at[2]), .axis = Vec3::UnitZ(), .weight = margin.at("S_K")});
  Misplaced misplaced(plan, placed, 1.5);
  const auto& curve = margin.at("curve");
  for (int sigma = 1; sigma <= 6; ++sigma)
    EXPECT_NEAR(misplaced.random(Vec3::Constant(sigma)), curve.at(std::to_string(sigma) + "mm")[0].get<double>(), 0.01)
        << sigma;
  EXPECT_NEAR(misplaced.random(Vec3(1.3, 1.5, 3.8)), curve.at("1.3/1.5/3.8")[0].get<double>(), 0.01);
  // The border of the gland lies where the dose falls steeply, so shifts are sampled more finely.
  Misplaced finely(plan, placed, 0.5);
  EXPECT_NEAR(finely.shifted(Vec3(0, 0, 5)), curve.at("z5")[0].get<double>(), 0.01);
  EXPECT_NEAR(finely.shifted(Vec3(0, 0, 10)), curve.at("z10")[0].get<double>(), 0.01);
  EXPECT_NEAR(finely.shifted(Vec3(0, 0, 15)), curve.at("z15")[0].get<double>(), 0.01);
  EXPECT_NEAR(finely.shifted(Vec3(0, 5, 0)), curve.at("y5")[0].get<double>(), 0.01);
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
