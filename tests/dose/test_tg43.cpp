// SPDX-License-Identifier: GPL-3.0-or-later
// The TG-43 formulas against definitions and closed forms.
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/tg43.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

namespace stylet {
namespace {

/// A line source of 3 mm whose tables are all 1, so that only its geometry counts.
SourceModel bare_line() {
  SourceModel source;
  source.name = "bare";
  source.isotope = "I-125";
  source.half_life_days = 59.4;
  source.dose_rate_constant = 1.0;
  source.active_length_mm = 3.0;
  source.g_r_mm = {10.0};
  source.g = {1.0};
  source.F_r_mm = {10.0};
  source.F_theta_deg = {0.0, 90.0};
  source.F = MatX::Ones(2, 1);
  return source;
}

// G_L is the mean of 1/d² over the line.
TEST(LineGeometry, is_the_mean_of_the_inverse_square_over_the_line) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> radius(2.0, 60.0);
  std::uniform_real_distribution<double> cosine(-1.0, 1.0);
  constexpr double length = 3.0;
  for (int k = 0; k < 200; ++k) {
    const double r = radius(random);
    const double c = cosine(random);
    const double along = r * c;
    const double across2 = r * r * (1.0 - c * c);
    double sum = 0.0;
    constexpr int parts = 2000;
    for (int i = 0; i < parts; ++i) {
      const double z = along - length * ((i + 0.5) / parts - 0.5);
      sum += 1.0 / (z * z + across2);
    }
    EXPECT_NEAR(line_geometry(r, c, length) / (sum / parts), 1.0, 1e-5) << r << " mm, " << c;
  }
  EXPECT_NEAR(line_geometry(4.0, 1.0, 3.0), 1.0 / (16.0 - 2.25), 1e-12) << "on the axis";
  EXPECT_NEAR(line_geometry(4.0, 1.0 - 1e-13, 3.0), 1.0 / (16.0 - 2.25), 1e-5) << "beside it";
  EXPECT_NEAR(line_geometry(200.0, 0.3, 3.0) * 200.0 * 200.0, 1.0, 1e-4) << "far away it is a point";
  EXPECT_EQ(line_geometry(4.0, 0.2, 0.0), 1.0 / 16.0);
}

TEST(Tg43, of_a_bare_line_is_its_geometry) {
  const Tg43 tg43 = Tg43::create(bare_line(), DoseFormalism::line2d).value();
  for (const double c : {0.0, 0.4, 0.9, 1.0})
    EXPECT_NEAR(tg43.rate(7.0, c), line_geometry(7.0, c, 3.0) / line_geometry(10.0, 0.0, 3.0), 1e-12);
}

// The mean over all directions of a bare line at r, over its value at 90°: with s = 2 r / L and r > L / 2,
// ∫ β sin⁰ dθ has the closed form (r / L) ln((r + L/2) / (r − L/2)) for the mean of 1/d², since the mean of the inverse
// square of a point source over a sphere that contains it is (1 / (2 r z)) ln((r + z) / (r − z)) for each point at z.
TEST(Tg43, mean_anisotropy_of_a_bare_line_is_that_of_its_points) {
  const Tg43 tg43 = Tg43::create(bare_line(), DoseFormalism::line1d).value();
  constexpr double r = 10.0;
  constexpr double length = 3.0;
  double mean = 0.0;
  constexpr int parts = 4000;
  for (int i = 0; i < parts; ++i) {
    const double z = length * ((i + 0.5) / parts - 0.5);
    mean += std::log((r + z) / (r - z)) / (2.0 * r * z) / parts;
  }
  EXPECT_NEAR(tg43.mean_anisotropy(r), mean / line_geometry(r, 0.0, length), 1e-6);
}

TEST(Tg43, formalisms_agree_at_the_tables_radii_on_the_transverse_axis_up_to_the_anisotropy) {
  const SourceModel source = find_source("i125_6711").value();
  const Tg43 line2d = Tg43::create(source, DoseFormalism::line2d).value();
  const Tg43 line1d = Tg43::create(source, DoseFormalism::line1d).value();
  const Tg43 point = Tg43::create(source, DoseFormalism::point).value();
  for (const double r : {5.0, 10.0, 20.0, 50.0}) {
    EXPECT_NEAR(line1d.rate(r, 0.7) / (line2d.rate(r, 0.0) * line1d.mean_anisotropy(r)), 1.0, 1e-12) << r;
    EXPECT_NEAR(point.rate(r, 0.2) / line1d.rate(r, 0.0), 1.0, 1e-12) << r;
  }
}

TEST(Tg43, tables_continue_as_the_supplement_recommends) {
  const Tg43 tg43 = Tg43::create(find_source("i125_6711").value(), DoseFormalism::line2d).value();
  EXPECT_EQ(tg43.radial(0.6), 1.055) << "constant below the first radius";
  EXPECT_NEAR(tg43.radial(12.5), std::sqrt(1.0 * 0.908), 1e-12) << "logarithmic between two";
  EXPECT_NEAR(tg43.radial(110.0), 0.0803 * 0.0803 / 0.109, 1e-12) << "exponential beyond the last";
  EXPECT_NEAR(tg43.anisotropy(7.5, 15.0), 0.25 * (0.519 + 0.537 + 0.716 + 0.705), 1e-12) << "linear in both";
  EXPECT_EQ(tg43.anisotropy(2.0, 0.0), 0.333) << "constant outside";
  EXPECT_EQ(tg43.anisotropy(10.0, 160.0), tg43.anisotropy(10.0, 20.0)) << "folded at 90 degrees";
  EXPECT_EQ(tg43.rate(0.1, 0.5), tg43.rate(0.5, 0.5)) << "no dose within the capsule";
  const Tg43 iridium = Tg43::create(find_source("ir192_flexisource").value(), DoseFormalism::line2d).value();
  const auto& r = iridium.source().g_r_mm;
  const auto& g = iridium.source().g;
  EXPECT_NEAR(iridium.radial(0.5 * (r[3] + r[4])), 0.5 * (g[3] + g[4]), 1e-12) << "linear for Ir-192";
}

TEST(Tg43, a_missing_anisotropy_takes_the_next_larger_radius) {
  SourceModel source = find_source("i125_6711").value();
  source.F(0, 0) = source.F(0, 1) = std::numeric_limits<double>::quiet_NaN();
  const Tg43 tg43 = Tg43::create(source, DoseFormalism::line2d).value();
  EXPECT_EQ(tg43.anisotropy(5.0, 0.0), source.F(0, 2));
}

TEST(PermanentImplant, decays_to_the_time_integral_of_its_rate) {
  // ∫ exp(−ln 2 t / T) dt = T / ln 2, in hours, and 100 cGy are one Gy.
  EXPECT_NEAR(permanent_Gy_per_rate(59.4), 59.4 * 24.0 / std::log(2.0) / 100.0, 1e-12);
}

// A plan that is turned and moved as a whole gives its dose at the points that are turned and moved with it; so it does
// in another order, and with axes that point the other way.
TEST(SumOfRates, of_a_plan_does_not_depend_on_frame_order_or_sense_of_the_axes) {
  const Tg43 tg43 = Tg43::create(find_source("i125_6711").value(), DoseFormalism::line2d).value();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-25.0, 25.0);
  const auto vector = [&] { return Vec3(place(random), place(random), place(random)); };
  std::vector<PlacedSource> plan;
  for (int k = 0; k < 30; ++k) plan.push_back({.at_mm = vector(), .axis = vector().normalized(), .weight = 0.5});
  std::vector<Vec3> points;
  for (int k = 0; k < 100; ++k) points.push_back(vector());
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(vector(), vector());
  const Vec3 shift = vector();
  std::vector<PlacedSource> moved(plan.rbegin(), plan.rend());
  for (PlacedSource& source : moved) source = {turn * source.at_mm + shift, -(turn * source.axis), source.weight};
  std::vector<Vec3> moved_points;
  for (const Vec3& x : points) moved_points.push_back(turn * x + shift);
  std::vector<double> rates(points.size());
  std::vector<double> moved_rates(points.size());
  sum_rates(tg43, plan, points, rates);
  sum_rates(tg43, moved, moved_points, moved_rates);
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_NEAR(moved_rates[k] / rates[k], 1.0, 1e-9) << k;
}

}  // namespace
}  // namespace stylet
