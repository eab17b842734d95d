// SPDX-License-Identifier: GPL-3.0-or-later
// A tip that has broken the skin stands in a dent that is eight times as deep as the needle is thick
// (docs/theory/near_field.md §5).
#include "coupling/needle_in_block.hpp"
#include "support/sanitized.hpp"

#include <tuple>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

class TipInTheDent : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(TipInTheDent, meets_a_force_that_only_falls_once_the_skin_is_broken) {
  constexpr double kPuncture_N = 1.0;
  constexpr double kCutting_N = 0.05;
  BlockOptions options;
  const auto [cells, stiffening_MPa] = GetParam();
  options.cells = {cells, cells, cells};
  options.region_at = [](const Vec3&) { return 0; };
  options.laws[0] = {kCutting_N, kPuncture_N, {}, false, true, -1};
  options.laws[0].stiffening_MPa = stiffening_MPa;
  NeedleInBlock run(options);
  run.aim({2.0, 3.0, 0.0}, Vec3::UnitZ(), 0.0);
  // Steps short enough to resolve the tip's motion through the dent, which takes some hundredths of a second.
  constexpr double dt = 2e-4;
  while (run.first(EventKind::puncture) == nullptr && run.depth < 30.0) run.go(run.depth + 0.01, 20.0, dt);
  ASSERT_NE(run.first(EventKind::puncture), nullptr);
  const auto broke = static_cast<std::size_t>(run.forces.size()) - 1;
  run.go(run.depth + 15.0, 20.0, dt);

  constexpr double hardly_N = 1e-3;
  double least = kPuncture_N;  // smallest force so far
  double rise = 0.0;
  for (std::size_t i = broke; i < run.forces.size(); ++i) {
    rise = std::max(rise, run.forces[i] - least);
    least = std::min(least, run.forces[i]);
  }
  EXPECT_LT(rise, hardly_N);
  EXPECT_NEAR(run.forces.back(), kCutting_N + options.coupling.tip_viscosity_Ns_per_mm * 20.0, 0.01);
  EXPECT_EQ(run.flags, 0u);
}
INSTANTIATE_TEST_SUITE_P(Meshes, TipInTheDent,
                         testing::Combine(testing::ValuesIn(test::meshes({5, 8, 14})),
                                          testing::Values(0.0, 0.03, 0.2)));

}  // namespace
}  // namespace stylet
