// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of an implant whose tissue swells.
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/known_sources.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace stylet {
namespace {

TEST(SwollenTimes, share_the_dose_and_have_the_mean_swelling_of_the_decaying_sources) {
  const Swelling swelling{.centre_mm = Vec3::Zero(), .at_start = Vec3(0.1, 0.2, 0.3), .half_life_days = 9.3};
  for (const double days : {30.0, static_cast<double>(INFINITY)}) {
    double shares = 0.0;
    Vec3 mean = Vec3::Zero();
    for (const SwollenTime& time : swollen_times(swelling, 59.4, days)) {
      shares += time.share;
      mean += time.share * time.factors;
    }
    EXPECT_NEAR(shares, 1.0, 1e-12);
    // ∫ e^(−λt) (1 + s e^(−μt)) dt / ∫ e^(−λt) dt
    const double lambda = std::numbers::ln2 / 59.4, mu = std::numbers::ln2 / 9.3;
    const double of_all = lambda / (lambda + mu) * -std::expm1(-(lambda + mu) * days) / -std::expm1(-lambda * days);
    EXPECT_LT((mean - Vec3::Ones() - of_all * swelling.at_start).norm(), 1e-12);
  }
}

/// Dose of one seed at a point 20 mm beside it, with a swelling about the seed.
double dose_at_20_mm(const Swelling& swelling, DoseQuantity quantity, double days = 0.0) {
  DosePlan plan;
  plan.sources.push_back({.at_mm = Vec3::Zero(), .axis = Vec3::UnitZ(), .has_axis = true, .strength_U = 1.0});
  DoseOptions options;
  options.quantity = quantity;
  options.days = days;
  options.swelling = swelling;
  options.points = {Vec3(20, 0, 0)};
  return evaluate_dose(plan, find_source("i125_6711").value(), {}, options).value().point_Gy.front();
}

TEST(EvaluateDose, with_swelling_is_the_integral_of_the_rate_on_the_way_of_the_tissue) {
  const Swelling swelling{.centre_mm = Vec3::Zero(), .at_start = Vec3::Constant(0.15), .half_life_days = 9.3};
  const Tg43 tg43 = Tg43::create(find_source("i125_6711").value(), DoseFormalism::line2d).value();
  const double lambda = std::numbers::ln2 / 59.4;
  double sum = 0.0;
  constexpr double step = 0.01;  // days; midpoint rule
  for (double t = 0.5 * step; t < 1500.0; t += step)
    sum += step * 24.0 * std::exp(-lambda * t) * tg43.rate(20.0 * swelling.factors(t).x(), 0.0) / 100.0;
  EXPECT_NEAR(dose_at_20_mm(swelling, DoseQuantity::total) / sum, 1.0, 3e-4);
  EXPECT_NEAR(dose_at_20_mm(swelling, DoseQuantity::initial_rate) / (tg43.rate(23.0, 0.0) / 100.0), 1.0, 1e-12);
  EXPECT_LT(dose_at_20_mm(swelling, DoseQuantity::total), dose_at_20_mm({}, DoseQuantity::total));
  // The swelling weighs more in the first month than in all.
  EXPECT_LT(dose_at_20_mm(swelling, DoseQuantity::until, 30.0) / dose_at_20_mm({}, DoseQuantity::until, 30.0),
            dose_at_20_mm(swelling, DoseQuantity::total) / dose_at_20_mm({}, DoseQuantity::total));
}

/// Seeds of random places and directions in a ball of 40 mm about the origin.
DosePlan random_plan(std::mt19937& random, int seeds) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  DosePlan plan;
  for (int k = 0; k < seeds; ++k) {
    const Vec3 to = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
    PlannedSource& seed = plan.sources.emplace_back();
    seed.at_mm = 40.0 * std::cbrt(uniform(random)) * to;
    seed.axis = axis;
    seed.has_axis = true;
    seed.strength_U = 0.5;
  }
  return plan;
}

// The grid's dose comes from a table, that of points from the formula, so that one checks the other.
TEST(EvaluateDose, with_swelling_is_that_of_the_formula_whether_it_is_the_same_in_all_directions_or_not) {
  std::mt19937 random(20);
  for (const Vec3& at_start : {Vec3(0.2, 0.2, 0.2), Vec3(-0.1, -0.1, -0.1), Vec3(0.05, 0.2, 0.1)}) {
    for (const DoseQuantity quantity : {DoseQuantity::total, DoseQuantity::initial_rate, DoseQuantity::until}) {
      DoseOptions options;
      options.grid_step_mm = 9.0;
      options.days = 20.0;
      options.quantity = quantity;
      options.swelling = {.centre_mm = Vec3(3, -4, 5), .at_start = at_start, .half_life_days = 9.3};
      const DosePlan plan = random_plan(random, 12);
      const SourceModel source = find_source("i125_6711").value();
      const DoseGrid grid = evaluate_dose(plan, source, {}, options).value().grid;
      for (Index i = 0; i < grid.size[0]; ++i)
        options.points.push_back(grid.point(i, grid.size[1] / 2, i % grid.size[2]));
      const std::vector<double> by_formula = evaluate_dose(plan, source, {}, options).value().point_Gy;
      for (Index i = 0; i < grid.size[0]; ++i) {
        const auto at =
            static_cast<std::size_t>(((i % grid.size[2]) * grid.size[1] + grid.size[1] / 2) * grid.size[0] + i);
        const double right = by_formula[static_cast<std::size_t>(i)];
        EXPECT_NEAR(grid.dose_Gy[at] / right, 1.0, 5e-4) << "at point " << i;
      }
    }
  }
}

}  // namespace
}  // namespace stylet
