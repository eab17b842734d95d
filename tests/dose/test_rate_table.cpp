// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/rate_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace stylet {
namespace {

constexpr std::array kFormalisms{DoseFormalism::line2d, DoseFormalism::line1d, DoseFormalism::point};

TEST(RateTable, is_within_five_ten_thousandths_of_the_formula_for_each_known_source_and_formalism) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.1, 150.0), cosine(-1.0, 1.0);
  for (const SourceModel& source : known_sources()) {
    for (const DoseFormalism formalism : kFormalisms) {
      const Tg43 tg43 = Tg43::create(source, formalism).value();
      const RateTable table(tg43);
      double worst = 0.0;
      for (int k = 0; k < 4000; ++k) {
        const double r = k % 2 == 0 ? radius(random) : 4.0 + radius(random) / 100.0;
        const double c = k % 10 == 0 ? std::copysign(1.0, cosine(random)) : cosine(random);
        worst = std::max(worst, std::abs(table.rate(r, c) / tg43.rate(r, c) - 1.0));
      }
      EXPECT_LT(worst, 5e-4) << source.name << " by " << to_string(formalism);
    }
  }
}

TEST(RateTable, adds_one_source_to_the_rates_that_are_there) {
  const RateTable table(Tg43::create(find_source("i125_6711").value(), DoseFormalism::line2d).value());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-40.0, 40.0);
  const auto anywhere = [&] { return Vec3(place(random), place(random), place(random)); };
  std::vector<PlacedSource> sources;
  for (int k = 0; k < 30; ++k) sources.push_back({anywhere(), anywhere().normalized(), 0.5});
  std::vector<Vec3> points(20000);
  for (Vec3& x : points) x = anywhere();
  std::vector<double> together(points.size()), one_by_one(points.size(), 0.0);
  sum_rates(table, sources, points, together);
  for (const PlacedSource& source : sources) table.add(source, points, one_by_one);
  for (std::size_t p = 0; p < points.size(); ++p) EXPECT_NEAR(one_by_one[p] / together[p], 1.0, 1e-12);
}

}  // namespace
}  // namespace stylet
