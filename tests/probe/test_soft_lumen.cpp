// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"
#include "stylet/sim/model.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

/// A block with a gland in front of a rectum, as a model.
Result<std::shared_ptr<const Model>> model_of(const Scenario& settings, bool with_lumen) {
  TetMesh mesh = box_mesh({-30, -30, -30}, {30, 30, 30}, {10, 10, 10});
  std::vector<std::string> regions{"body", "prostate", "rectum"};
  if (with_lumen) regions.emplace_back("rectal_lumen");
  assign_regions(mesh, regions, [&](const Vec3& x) {
    if (x.squaredNorm() < 100.0) return 1;
    const double from_axis = std::hypot(x.x(), x.y() - 18.0);
    if (from_axis < 6.0) return with_lumen ? 3 : 2;
    return from_axis < 11.0 ? 2 : 0;
  });
  Scenario scenario = settings;
  scenario.patient.source = "block";
  InsertionPlan plan;
  plan.entry_mm = std::array<double, 3>{2.0, 1.0, -30.0};
  plan.target_mm = std::array<double, 3>{2.0, 1.0, 0.0};
  scenario.insertions = {plan};
  return Model::compile(scenario, std::move(mesh), "block");
}

double young_kPa(const Model& model, const char* region) {
  return 1e3 * model.tissue().material(model.mesh().region_index(region)).young_MPa;
}

TEST(SoftLumen, is_soft_and_compressible_only_where_a_probe_is) {
  Scenario scenario;
  const double filled = tissue_of(scenario, "rectal_lumen").young_kPa;
  scenario.probe.kind = ProbeKind::biplane;
  const TissueParameters around = tissue_of(scenario, "rectal_lumen");
  EXPECT_DOUBLE_EQ(around.young_kPa, 0.5);
  EXPECT_LT(around.poisson, 0.2);
  EXPECT_GT(filled, around.young_kPa);
  EXPECT_EQ(tissue_of(scenario, "rectum"), tissue_of(Scenario{}, "rectum"));
}

TEST(SoftLumen, is_what_the_scenario_says_where_it_says_so) {
  Scenario scenario;
  scenario.probe.kind = ProbeKind::biplane;
  scenario.tissue["rectal_lumen"] = default_tissue("rectal_lumen", scenario.tissue_model.preset);
  scenario.tissue["rectal_lumen"].young_kPa = 7.0;
  EXPECT_DOUBLE_EQ(tissue_of(scenario, "rectal_lumen").young_kPa, 7.0);
}

TEST(SoftLumen, is_in_the_model_and_a_rectum_without_lumen_is_soft_as_a_whole) {
  Scenario scenario;
  scenario.probe.kind = ProbeKind::biplane;
  const auto with_lumen = model_of(scenario, true);
  ASSERT_TRUE(with_lumen) << with_lumen.error().message();
  EXPECT_NEAR(young_kPa(**with_lumen, "rectal_lumen"), 0.5, 1e-12);
  EXPECT_GT(young_kPa(**with_lumen, "rectum"), 5.0);
  const auto without = model_of(scenario, false);
  ASSERT_TRUE(without) << without.error().message();
  EXPECT_NEAR(young_kPa(**without, "rectum"), 0.5, 1e-12);
  const auto no_probe = model_of(Scenario{}, false);
  ASSERT_TRUE(no_probe) << no_probe.error().message();
  EXPECT_GT(young_kPa(**no_probe, "rectum"), 5.0);
}

}  // namespace
}  // namespace stylet
