// SPDX-License-Identifier: GPL-3.0-or-later
// All rows have a name and all their texts, and the rows that only need algebra pass.
#include "evidence/validate/number_table.hpp"
#include "stylet/evidence/validate/calculix.hpp"
#include "stylet/evidence/validate/context.hpp"
#include "stylet/evidence/validate/validation.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/io/scenario_io.hpp"
#include "support/says.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::validate;

TEST(Rows, have_a_name_of_their_own_and_say_what_is_claimed_and_against_what) {
  std::set<std::string> ids;
  for (const RowSpec& row : all_rows()) {
    EXPECT_TRUE(ids.insert(row.id).second) << row.id << " twice";
    EXPECT_TRUE(std::all_of(row.id.begin(), row.id.end(), [](unsigned char c) {
      return std::islower(c) || std::isdigit(c) || c == '_';
    })) << row.id;
    EXPECT_FALSE(row.claim.empty() || row.claim.back() == '.') << row.id;
    EXPECT_FALSE(row.reference.empty()) << row.id;
    EXPECT_TRUE(row.measure) << row.id;
  }
  EXPECT_EQ(ids.count("sensitivity"), 0u) << "--only takes this word for the study";
}

TEST(Rows, of_one_group_follow_each_other) {
  const auto& rows = all_rows();
  EXPECT_TRUE(
      std::is_sorted(rows.begin(), rows.end(), [](const RowSpec& a, const RowSpec& b) { return a.group < b.group; }));
  EXPECT_EQ(rows.front().group, Group::analysis);
  EXPECT_EQ(rows.back().group, Group::independence);
}

TEST(Rows, say_so_where_their_source_has_not_been_verified) {
  const auto& rows = all_rows();
  const auto row = std::find_if(rows.begin(), rows.end(), [](const RowSpec& r) { return r.id == "demo_speed_ratio"; });
  ASSERT_NE(row, rows.end());
  EXPECT_NE(row->reference.find("NOT VERIFIED"), std::string::npos) << row->reference;
  EXPECT_EQ(row->reference.find("McLaughlin"), std::string::npos)
      << "McLaughlin et al. give no figure for slow needles: " << row->reference;
}

TEST(Rows, that_algebra_decides_pass) {
  ValidateOptions options;
  options.only = {"patch_test",       "rigid_motions",     "uniaxial_bar",
                  "condensed_system", "needle_small_beam", "needle_large_beam"};
  const auto validation = value_of(validate::validate(options));
  ASSERT_EQ(validation.rows.size(), options.only.size());
  for (const Row& row : validation.rows) {
    EXPECT_EQ(row.verdict, Verdict::pass) << row.spec.id << ": " << row.finding.value << ", " << row.note();
    EXPECT_GT(row.finding.value, 0.0) << row.spec.id << ": nothing was computed";
  }
}

TEST(Rows, that_need_shared_data_are_skipped_plainly_without_it) {
  ValidateOptions options;
  options.only = {"step_time", "liver_recording", "tip_tracking"};
  options.data = "/nowhere";
  const auto validation = value_of(validate::validate(options));
  for (const Row& row : validation.rows) {
    EXPECT_EQ(row.verdict, Verdict::skipped) << row.spec.id;
    EXPECT_NE(row.note().find("STYLET_SHARED_DATA"), std::string::npos) << row.note();
  }
}

TEST(CalculiX, computes_the_same_displacements) {
  const auto validation = value_of(validate::validate({.only = {"calculix", "calculix_quadratic"}}));
  EXPECT_EQ(validation.rows.size(), 2u);
  for (const Row& row : validation.rows) {
    if (row.verdict == Verdict::skipped) GTEST_SKIP() << row.note();
    EXPECT_EQ(row.verdict, Verdict::pass) << row.finding.value << ", " << row.note();
  }
}

TEST(CalculiX, deck_has_every_node_element_support_and_load) {
  const auto tissue = value_of(Tissue::build(box_mesh({0, 0, 0}, {10, 10, 10}, {1, 1, 1}), {{0.02, 0.45}}, {0, 1, 2}));
  VecX f = VecX::Zero(3 * tissue.displacement_nodes());
  f[3 * 7 + 2] = -0.5;
  const std::string deck = calculix_deck(tissue, f);
  expect_says(deck, {"8, 1.000000000000e+01, 1.000000000000e+01, 1.000000000000e+01\n",
                     "*ELEMENT, TYPE=C3D4, ELSET=R0\n1, ", "*ELASTIC\n2.000000000000e-02, 4.500000000000e-01\n",
                     "*BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n", "*CLOAD\n8, 3, -5.000000000000e-01\n"});
}

TEST(DemoScenario, is_the_demo_that_is_shipped) {
  const auto shipped = value_of(read_scenario(STYLET_SCENARIOS "/demo.toml"));
  Scenario ours = measure::demo_scenario();
  ours.name = shipped.name;
  EXPECT_EQ(to_toml(ours), to_toml(shipped));
}

/// Root mean square difference of a row's curve from its reference, relative to the reference's largest value [%].
double rms_percent(const Curve& curve, const Curve& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.x.size(); ++i)
    sum += std::pow(interpolated(curve.x, curve.y, reference.x[i]) - reference.y[i], 2);
  return 100.0 * std::sqrt(sum / static_cast<double>(reference.x.size())) / reference.y.back();
}

TEST(LiverCurves, are_met_by_the_dent_that_stiffens_twice_as_nearly_as_by_any_linear_tissue) {
  const auto validation = value_of(validate::validate({.only = {"liver_curve", "liver_other_curve"}}));
  ASSERT_EQ(validation.rows.size(), 2u);
  for (const Row& row : validation.rows) {
    EXPECT_EQ(row.verdict, Verdict::pass) << row.finding.value << ", " << row.note();
    EXPECT_NE(row.spec.reference.find("NOT VERIFIED"), std::string::npos) << row.spec.reference;
    const std::vector<Curve>& curves = row.finding.plot.curves;
    ASSERT_EQ(curves.size(), 3u);
    const Curve& published = curves[2];
    EXPECT_EQ(published.x.front(), 2.0);
    EXPECT_NEAR(row.finding.value, rms_percent(curves[0], published), 1e-9);
    EXPECT_LT(2.0 * row.finding.value, rms_percent(curves[1], published)) << row.note();
    // The null model has the best possible fit.
    for (const double factor : {0.95, 1.05}) {
      Curve other = curves[1];
      for (double& force : other.y) force *= factor;
      EXPECT_GT(rms_percent(other, published), rms_percent(curves[1], published));
    }
  }
}
