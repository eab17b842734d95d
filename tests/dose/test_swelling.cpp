// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of an implant whose tissue swells.
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/known_sources.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

}  // namespace
}  // namespace stylet
