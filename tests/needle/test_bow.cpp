// SPDX-License-Identifier: GPL-3.0-or-later
// Tests needles that are not straight without loads.
#include "needle_model_test.hpp"

#include <cmath>
#include <numbers>

namespace stylet {
namespace {

using test::kLength;
constexpr double kBow = 4.0;

class BowedNeedle : public test::NeedleModelTest {
 protected:
  [[nodiscard]] static std::unique_ptr<Needle> bowed(double mm, double degrees) {
    NeedleSection section;
    section.bow_mm = mm;
    section.bow_deg = degrees;
    auto built = make_needle(model(), section, 0, 16);
    EXPECT_TRUE(built.ok()) << (built.ok() ? "" : built.error().message());
    return std::move(built).value();
  }
};

TEST_P(BowedNeedle, unloaded_has_its_tip_where_the_bow_says_and_stores_nothing) {
  for (const double degrees : {0.0, 90.0, 213.0}) {
    const auto needle = bowed(kBow, degrees);
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vec3 side(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 tip = needle->point(kLength);
    EXPECT_NEAR(tip.dot(side), kBow, 1e-9);
    EXPECT_NEAR(tip.dot(side.cross(Vec3::UnitZ())), 0.0, 1e-9);
    EXPECT_EQ(needle->energy(), 0.0);
    EXPECT_LT(needle->residual({}), 1e-12);
    // On a circle, the offset half way is a quarter, apart from the corners between elements.
    EXPECT_NEAR(needle->point(kLength / 2).dot(side), kBow / 4.0, 0.005 * kBow);
    EXPECT_NEAR(needle->tangent(kLength).dot(side), 2.0 * kBow / kLength, 0.03 * 2.0 * kBow / kLength);
    EXPECT_NEAR(needle->tangent(0.0).z(), 1.0, 1e-12);
  }
}

TEST_P(BowedNeedle, comes_back_to_its_bow_from_any_shape) {
  const auto needle = bowed(kBow, 30.0);
  const Vec3 tip = needle->point(kLength);
  const VecX unloaded = needle->state();
  test::settle(*needle, std::vector<PointLoad>{{kLength, {0.2, -0.3, 0.1}}}, tolerance());
  EXPECT_GT((needle->point(kLength) - tip).norm(), 10.0);
  settle(*needle, {});
  EXPECT_LT((needle->point(kLength) - tip).norm(), 1e-6);
  needle->straighten();
  EXPECT_EQ(VecX(needle->state()), unloaded);
  needle->set_state(VecX::Zero(unloaded.size()));  // held straight: the bending energy is EI κ² L / 2
  EXPECT_NEAR(needle->point(kLength).x(), 0.0, 1e-12);
  if (model() == "tet") return;  // nodes on straight lines do not have the least energy of a straight shaft
  const double curvature = 2.0 * kBow / (kLength * kLength);
  EXPECT_NEAR(needle->energy(), 0.5 * NeedleSection{}.bending_stiffness_Nmm2 * curvature * curvature * kLength,
              0.03 * needle->energy());
}

TEST_P(BowedNeedle, superposed_small_loads_bend_it_as_they_bend_a_straight_one) {
  const auto straight = make();
  const auto needle = bowed(kBow, 0.0);
  const Vec3 tip = needle->point(kLength);
  for (const Vec3& force : {Vec3(1e-4, 0, 0), Vec3(-1e-4, 0, 0), Vec3(0, 1e-4, 0)}) {
    needle->straighten();
    straight->straighten();
    settle(*needle, std::vector<PointLoad>{{kLength, force}, {120.0, force}});
    settle(*straight, std::vector<PointLoad>{{kLength, force}, {120.0, force}});
    const Vec3 expected = straight->point(kLength) - Vec3(0, 0, kLength);
    EXPECT_LT((needle->point(kLength) - tip - expected).head<2>().norm(), 0.005 * expected.norm());
  }
}

TEST_P(BowedNeedle, compliance_is_how_equilibrium_positions_follow_the_loads) {
  const auto needle = bowed(10.0, 75.0);
  const std::vector<PointLoad> loads{{kLength, {0.1, 0.2, -0.1}}, {111.0, {-0.2, 0.1, 0.0}}};
  settle(*needle, loads);
  const MatX compliance = test::compliance_of(*needle, loads);
  const MatX differences = compliance_by_differences(*needle, loads);
  for (Eigen::Index column = 0; column < compliance.cols(); ++column)
    EXPECT_LT((differences - compliance).col(column).norm(), 2e-6 * compliance.norm()) << column;
}

STYLET_FOR_EVERY_NEEDLE_MODEL(BowedNeedle);

}  // namespace
}  // namespace stylet
