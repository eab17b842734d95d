// SPDX-License-Identifier: GPL-3.0-or-later
// The forecast of where a seed would rest finds the point of the tissue that is at the seed's place now, also while the
// needle goes on moving.
#include "seed_forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stylet::serve {
namespace {

/// Tissue that a needle has dragged along by `most` mm at the origin, and less at a distance.
Vec3 moved(const Vec3& x, double most) { return x + Vec3(0, 0, most * std::exp(-x.norm() / 12.0)); }

TEST(SeedForecast, finds_the_tissue_at_the_place_of_the_seed) {
  SeedForecast forecast;
  forecast.aim(SeedForecast::Places{Vec3(0, 0, 10), Vec3(0, 0, 10)});
  EXPECT_FALSE(forecast.off_mm()) << "nothing is known before the first answer";
  for (int k = 0; k < 60 && forecast.take(moved(*forecast.point(), 8.0)); ++k) {
  }
  ASSERT_TRUE(forecast.rest());
  EXPECT_LT((moved(*forecast.rest(), 8.0) - Vec3(0, 0, 10)).norm(), 0.05);
  EXPECT_NEAR(*forecast.off_mm(), 10.0 - forecast.rest()->z(), 1e-9);
}

TEST(SeedForecast, follows_a_needle_that_moves) {
  SeedForecast forecast;
  double z = 0;
  for (int k = 0; k < 100; ++k) {
    z += 0.3;  // 20 mm/s, 60 pictures a second
    forecast.aim(SeedForecast::Places{Vec3(0, 0, z), Vec3(0, 0, z)});
    forecast.take(moved(*forecast.point(), 5.0));
  }
  ASSERT_TRUE(forecast.rest());
  EXPECT_LT((moved(*forecast.rest(), 5.0) - Vec3(0, 0, z)).norm(), 0.5);
}

TEST(SeedForecast, knows_nothing_of_a_tip_in_the_air) {
  SeedForecast forecast;
  forecast.aim(SeedForecast::Places{Vec3(0, 0, 10), Vec3(0, 0, 10)});
  forecast.take(Vec3(0, 0, 10));
  EXPECT_TRUE(forecast.off_mm());
  forecast.aim(std::nullopt);
  EXPECT_FALSE(forecast.point());
  EXPECT_FALSE(forecast.off_mm());
}

}  // namespace
}  // namespace stylet::serve
