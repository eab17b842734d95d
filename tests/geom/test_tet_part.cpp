// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/tet_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stylet {
namespace {

double share(const std::vector<TetPart>& parts) {
  double sum = 0.0;
  for (const TetPart& part : parts) sum += share_of_tet(part);
  return sum;
}

/// Sum over the parts of the mean of a linear function × the part's share of the tetrahedron.
double integral(const std::vector<TetPart>& parts, const Vec4& values) {
  double sum = 0.0;
  for (const TetPart& part : parts) sum += share_of_tet(part) * (part.transpose() * values).mean();
  return sum;
}

TEST(PartsOfATetrahedron, between_levels_of_one_corner_have_the_cone_s_volume) {
  const Vec4 height(1.0, 0.0, 0.0, 0.0);  // the part below c is the whole without a cone of volume (1 − c)³
  for (const double c : {0.0, 0.1, 0.5, 0.9, 1.0})
    EXPECT_NEAR(share(parts_between(height, -1.0, c)), 1.0 - std::pow(1.0 - c, 3), 1e-14) << c;
  EXPECT_NEAR(share(parts_between(height, 0.25, 0.5)), std::pow(0.75, 3) - std::pow(0.5, 3), 1e-14);
}

TEST(PartsOfATetrahedron, where_nothing_is_are_none) {
  EXPECT_EQ(share(parts_between({0.0, 1.0, 2.0, 3.0}, 3.5, 4.0)), 0.0);
  EXPECT_EQ(share(parts_between({0.0, 1.0, 2.0, 3.0}, -2.0, -1.0)), 0.0);
}

TEST(PartsOfATetrahedron, of_successive_levels_make_up_the_whole_and_keep_to_their_levels) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(-1.0, 1.0);
  for (int repeat = 0; repeat < 200; ++repeat) {
    Vec4 values = Vec4::NullaryExpr([&] { return some(random); });
    if (repeat % 4 == 0) values[1] = values[2];  // an edge on which the function is constant
    if (repeat % 8 == 0) values[3] = values[2];
    const std::array<double, 4> levels{-2.0, repeat % 3 == 0 ? values[0] : -0.3, 0.4 + 0.6 * std::abs(values[0]), 2.0};
    double whole = 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      const double low = std::min(levels[k], levels[k + 1]), high = std::max(levels[k], levels[k + 1]);
      const auto parts = parts_between(values, low, high);
      whole += share(parts);
      sum += integral(parts, values);
      for (const TetPart& part : parts) {
        EXPECT_TRUE(part.colwise().sum().isApproxToConstant(1.0, 1e-12));
        EXPECT_GE(part.minCoeff(), -1e-12);
        EXPECT_GE((part.transpose() * values).minCoeff(), low - 1e-12);
        EXPECT_LE((part.transpose() * values).maxCoeff(), high + 1e-12);
      }
    }
    EXPECT_NEAR(whole, 1.0, 1e-12);
    EXPECT_NEAR(sum, values.mean(), 1e-12);
  }
}

}  // namespace
}  // namespace stylet
