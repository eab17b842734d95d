// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/near_field/navier.hpp"
#include "stylet/coupling/near_field/kelvinlet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stylet {
namespace {

const Medium kMedium{3.4e-3, 0.45};

TEST(Kelvinlet, is_the_field_of_a_force_spread_over_its_radius) {
  // De Goes & James 2017, eq. 7: force density 15 ε⁴ / (8π r_ε⁷).
  const double epsilon = 1.3;
  const Vec3 force(0.3, -0.2, 0.5);
  for (const Vec3& r : {Vec3(0, 0, 0), Vec3(0.4, 0.2, -0.3), Vec3(1.5, -1.0, 0.7), Vec3(3, 4, -2)}) {
    const auto u = [&](const Vec3& x) { return Vec3(kelvinlet(x, epsilon, kMedium) * force); };
    const double spread = std::sqrt(r.squaredNorm() + epsilon * epsilon);
    const Vec3 density = 15.0 * std::pow(epsilon, 4) / (8.0 * std::numbers::pi * std::pow(spread, 7)) * force;
    EXPECT_LT((test::body_force(u, r, kMedium) - density).norm(), 1e-4 * force.norm()) << r.transpose();
  }
}

TEST(Kelvinlet, is_kelvins_solution_far_away) {
  const Vec3 r(30, -20, 40);
  const double nu = kMedium.poisson;
  const double scale = 1.0 / (16.0 * std::numbers::pi * kMedium.mu * (1.0 - nu) * r.norm());
  const Mat3 kelvin = scale * ((3.0 - 4.0 * nu) * Mat3::Identity() + r * r.transpose() / r.squaredNorm());
  EXPECT_LT((kelvinlet(r, 0.5, kMedium) - kelvin).norm(), 1e-3 * kelvin.norm());
  EXPECT_LT((kelvinlet(r, 1e-6, kMedium) - kelvin).norm(), 1e-12 * kelvin.norm());
}

TEST(Kelvinlet, self_compliance_is_the_mean_of_its_diagonal) {
  EXPECT_NEAR(kelvinlet(Vec3::Zero(), 2.0, kMedium).trace() / 3.0, kelvinlet_self(kMedium) / 2.0, 1e-12);
  const double nu = kMedium.poisson;
  EXPECT_NEAR(kelvinlet_self(kMedium), (5.0 - 6.0 * nu) / (16.0 * std::numbers::pi * kMedium.mu * (1.0 - nu)), 1e-12);
}

/// The mean over two pieces by the midpoint rule, accurate to a millionth.
Mat3 by_quadrature(const Segment& at, const Segment& on, double epsilon) {
  constexpr int fine = 600;
  Mat3 sum = Mat3::Zero();
  const int points_at = at.length > 0.0 ? fine : 1;
  const int points_on = on.length > 0.0 ? fine : 1;
  for (int i = 0; i < points_at; ++i) {
    const Vec3 x = at.centre + ((i + 0.5) / points_at - 0.5) * at.length * at.direction;
    for (int j = 0; j < points_on; ++j)
      sum += kelvinlet(x - on.centre - ((j + 0.5) / points_on - 0.5) * on.length * on.direction, epsilon, kMedium);
  }
  return sum / (points_at * points_on);
}

TEST(Kelvinlet, mean_over_pieces_of_needle_in_closed_form_equals_quadrature) {
  const Vec3 direction = Vec3(0.2, -0.3, 1.0).normalized();
  const Vec3 across = direction.unitOrthogonal();
  const double epsilon = 1.047;
  struct Case {
    double along, beside, at, on;
  };
  for (const Case& c : {Case{0, 0, 4, 4}, Case{4, 0, 4, 4}, Case{-2.5, 0.3, 4, 2}, Case{1, 0, 0, 4}, Case{1, 0.5, 4, 0},
                        Case{9, 3, 0, 0}, Case{-40, 2, 8, 4}, Case{0, 0, 0, 0}}) {
    const Segment at{Vec3(1, 2, 3) + c.along * direction + c.beside * across, direction, c.at};
    const Segment on{Vec3(1, 2, 3), direction, c.on};
    const Mat3 closed = kelvinlet(at, on, direction, epsilon, kMedium);
    EXPECT_LT((closed - by_quadrature(at, on, epsilon)).norm(), 3e-6 * closed.norm()) << c.along << " " << c.at;
    EXPECT_LT((closed - kelvinlet(on, at, direction, epsilon, kMedium).transpose()).norm(), 1e-12 * closed.norm());
  }
}

}  // namespace
}  // namespace stylet
