// SPDX-License-Identifier: GPL-3.0-or-later
// A strong surface breaks, and the tip is then held by a quarter of the force.
#include "needle_in_block.hpp"

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

class Snap : public testing::TestWithParam<int> {};

TEST_P(Snap, after_a_surface_breaks_no_step_is_without_a_balance) {
  const int cells = GetParam();
  const double interface = 100.0 / cells * std::round(0.14 * cells);  // on element faces
  BlockOptions options;
  options.cells = {cells, cells, cells};
  options.jitter = 0.0;
  options.regions = {"fat", "gland"};
  options.region_at = [=](const Vec3& x) { return x.z() < interface ? 0 : 1; };
  options.materials = {{0.004, 0.45}, {0.06, 0.45}};
  const FrictionLaw friction{18e-3, 11e-3, 250e-6, 50.0};
  options.laws = {{0.3, 0.0, friction, false, true, -1, 0.008}, {1.5, 5.7, friction, false, false, -1, 0.12}};
  options.element = Element::nodal_pressure;
  options.coupling.creep = {4.0, 0.6};
  NeedleInBlock run(options);
  run.aim({1.3, 0.7, 0.0}, {0.4, 0.1, 1.0});
  run.go(60.0);
  EXPECT_EQ(run.count(EventKind::puncture), 2) << "the outer surface and the capsule";
  EXPECT_EQ(run.report.tip_state, TipState::cutting);
  EXPECT_EQ(run.flags & Step::not_converged, 0u);
}
INSTANTIATE_TEST_SUITE_P(Cells, Snap, testing::Values(8, 12, 16));

}  // namespace
}  // namespace stylet
