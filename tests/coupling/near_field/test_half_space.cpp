// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/near_field/navier.hpp"
#include "stylet/coupling/near_field/half_space.hpp"
#include "stylet/coupling/near_field/needle_kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stylet {
namespace {

const Medium kHalfSpaceMedium{3.4e-3, 0.45};
const Vec3 kInwards = Vec3(0.3, -0.2, 0.9).normalized();

/// Displacement field of a force at `source` in the half space x·n ≥ 0 with a free surface.
Vec3 half_space(const Vec3& x, const Vec3& source, const Vec3& force, double epsilon) {
  const SurfacePair surface{kInwards, kInwards.dot(x), kInwards.dot(source)};
  return (kelvinlet(x - source, epsilon, kHalfSpaceMedium) +
          free_surface_image(x - source, surface, epsilon, kHalfSpaceMedium)) *
         force;
}

const Vec3 kSource = 4.0 * kInwards + Vec3(1, 2, 3) - kInwards.dot(Vec3(1, 2, 3)) * kInwards;

TEST(FreeSurface, a_force_below_it_leaves_it_free_of_traction) {
  for (const Vec3& force : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    const auto u = [&](const Vec3& x) { return half_space(x, kSource, force, 1e-6); };
    for (const Vec3& way : {Vec3(0, 0, 0), Vec3(2, 1, 0), Vec3(-5, 3, 8)}) {
      const Vec3 x = kSource + way - kInwards.dot(kSource + way) * kInwards;
      const Mat3 s = test::stress(u, x, kHalfSpaceMedium);
      EXPECT_LT((s * kInwards).norm(), 1e-5 * s.norm() + 1e-9) << way.transpose();
    }
  }
}

TEST(FreeSurface, the_field_is_in_balance_below_it) {
  for (const Vec3& force : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    const auto u = [&](const Vec3& x) { return half_space(x, kSource, force, 1e-6); };
    for (const Vec3& way : {Vec3(2, 1, 3), Vec3(-3, 3, 1)}) {
      const Vec3 x = kSource + way;
      ASSERT_GT(kInwards.dot(x), 0.5);
      EXPECT_LT(test::body_force(u, x, kHalfSpaceMedium).norm(), 1e-6) << way.transpose();
    }
  }
}

TEST(FreeSurface, action_equals_reaction) {
  const Vec3 one = kSource;
  const Vec3 two = kSource + Vec3(2, -1, 1.5);
  for (const double epsilon : {1e-6, 1.0, 6.0}) {
    const SurfacePair there{kInwards, kInwards.dot(two), kInwards.dot(one)};
    const SurfacePair back{kInwards, kInwards.dot(one), kInwards.dot(two)};
    const Mat3 forth = free_surface_image(two - one, there, epsilon, kHalfSpaceMedium);
    EXPECT_LT((forth - free_surface_image(one - two, back, epsilon, kHalfSpaceMedium).transpose()).norm(),
              1e-12 * forth.norm());
  }
}

TEST(FreeSurface, a_force_on_it_is_boussinesqs) {
  const double distance = 7.0;
  const Vec3 x = distance * kInwards.unitOrthogonal();
  const double normal = kInwards.dot(half_space(x, Vec3::Zero(), kInwards, 1e-6));
  EXPECT_NEAR(normal, (1.0 - kHalfSpaceMedium.poisson) / (2.0 * std::numbers::pi * kHalfSpaceMedium.mu * distance),
              1e-9);
}

TEST(FreeSurface, a_tip_pressed_on_it_gives_way_like_a_flat_punch) {
  const NeedleKernel needle{.radius_mm = 0.635};
  for (const double poisson : {0.3, 0.45, 0.49}) {
    const Medium medium{0.02, poisson};
    const double young = 2.0 * medium.mu * (1.0 + poisson);
    const NearSurface skin{0.0, Vec3::UnitZ(), 1.0};
    const double punch = (1.0 - poisson * poisson) / (2.0 * needle.radius_mm * young);
    EXPECT_NEAR(tip_kernel(skin, {}, needle.own_tip_epsilon(skin, {}, poisson), medium)(2, 2), punch, 1e-9 * punch);
    // Places right beside the tip move as far as the punch.
    const double epsilon = needle.tip_epsilon(skin, poisson);
    const Mat3 G = kelvinlet(Vec3::Zero(), epsilon, medium) +
                   free_surface_image(Vec3::Zero(), {Vec3::UnitZ(), 0.0, 0.0}, epsilon, medium);
    EXPECT_NEAR(G(2, 2), punch, 1e-9 * punch);
  }
}

}  // namespace
}  // namespace stylet
