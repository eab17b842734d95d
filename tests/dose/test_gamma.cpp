// SPDX-License-Identifier: GPL-3.0-or-later
// The gamma index of doses for which it is known in closed form.
#include "stylet/dose/gamma.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace stylet {
namespace {

constexpr double kAtOrigin_Gy = 100.0;

/// Rates at the origin, where the reference has 100 Gy, of a dose with a gradient that is 100 Gy somewhere else.
/// For a linear dose, γ = |ΔD| / √(allowed² + (gradient · distance)²), by the distance of a point from a line.
GammaRates of_linear_dose(const Vec3& gradient, double difference_Gy, double global_Gy) {
  const DoseAtPoints dose = [&](std::span<const Vec3> points) {
    std::vector<double> doses;
    for (const Vec3& x : points) doses.push_back(kAtOrigin_Gy + difference_Gy + gradient.dot(x));
    return doses;
  };
  const std::vector<Vec3> point{Vec3::Zero()};
  const std::vector<double> reference{kAtOrigin_Gy}, evaluated{kAtOrigin_Gy + difference_Gy};
  return gamma_rates(point, reference, evaluated, dose, global_Gy).value();
}

TEST(Gamma, passes_up_to_the_known_difference_of_a_shifted_linear_dose) {
  for (const double slope : {0.0, 2.0, 10.0, 40.0}) {
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, 1, 1), Vec3(-2, 1, 0.3), Vec3(0.1, 0.2, -1)}) {
      const Vec3 gradient = slope * direction.normalized();
      for (const double global_Gy : {100.0, 300.0}) {
        const double local = std::hypot(3.0, slope), global = std::hypot(0.03 * global_Gy, slope);
        for (const double sign : {-1.0, 1.0}) {
          EXPECT_EQ(of_linear_dose(gradient, sign * 0.97 * local, global_Gy).local_percent, 100.0) << gradient;
          EXPECT_EQ(of_linear_dose(gradient, sign * 1.001 * local, global_Gy).local_percent, 0.0) << gradient;
          EXPECT_EQ(of_linear_dose(gradient, sign * 0.97 * global, global_Gy).global_percent, 100.0) << gradient;
          EXPECT_EQ(of_linear_dose(gradient, sign * 1.001 * global, global_Gy).global_percent, 0.0) << gradient;
        }
      }
    }
  }
}

TEST(Gamma, judges_points_above_the_threshold_only_and_thins_many_of_them) {
  std::vector<Vec3> points(45000, Vec3::Zero());
  std::vector<double> reference(points.size(), 5.0);
  std::fill(reference.begin(), reference.begin() + 30000, 50.0);
  const std::vector<double> evaluated(points.size(), 51.0);
  const DoseAtPoints dose = [](std::span<const Vec3> at) { return std::vector<double>(at.size(), 51.0); };
  const GammaRates rates = gamma_rates(points, reference, evaluated, dose, 100.0).value();
  EXPECT_EQ(rates.points, 10000U) << "30,000 are above the threshold";
  EXPECT_EQ(rates.local_percent, 100.0);
  EXPECT_EQ(gamma_rates({}, {}, {}, dose, 100.0).value().points, 0U);
}

}  // namespace
}  // namespace stylet
