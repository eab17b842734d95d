// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_patient.hpp"
#include "stylet/sim/tenting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace stylet;
using namespace stylet::test;

TEST(ModelElement, is_the_chosen_one_and_linear_by_itself_for_the_methods_of_the_paper) {
  Scenario s = box_scenario();
  for (const char* method : {"node-addition", "embedded"}) {
    s.coupling.method = choice<CouplingSettings::Method>(method).value();
    EXPECT_EQ(compiled(s)->tissue().element(), Element::p1);
  }
  for (const Element element : {Element::p1, Element::nodal_pressure, Element::p2}) {
    s.tissue_model.element = choice<ElementChoice>(to_string(element)).value();
    EXPECT_EQ(compiled(s)->tissue().element(), element);
  }
}

// Errors of scenarios and meshes.

TEST(ModelRefuses, a_needle_that_misses_the_patient) {
  Scenario s = box_scenario();
  s.insertions[0].entry_mm = {45.0, 7.0, -20.0};
  const Error error = refused(s);
  EXPECT_SAYS(error.message(), "case.toml, insertion[0]");
  EXPECT_SAYS(error.what, "misses the patient");
  EXPECT_SAYS(error.what, "(45.0, 7.0, -20.0) mm along (0.000, 0.000, 1.000)");
  EXPECT_SAYS(error.what, "from (-30.0, -30.0, 0.0) mm to (30.0, 30.0, 60.0) mm");
  EXPECT_SAYS(error.cure, "template.centre_mm");
}

TEST(ModelRefuses, a_template_hole_beside_the_patient) {
  Scenario s = box_scenario();
  s.insertions[0] = {};
  s.insertions[0].hole = "G4";
  s.grid.pitch_mm = 10.0;
  EXPECT_SAYS(refused(s).what, "misses the patient");
}

TEST(ModelRefuses, tissue_of_a_region_that_is_not_there_and_names_the_nearest) {
  Scenario s = box_scenario();
  s.tissue["prostat"] = default_tissue("prostate");
  const Error error = refused(s);
  EXPECT_EQ(error.where, "case.toml, [tissue.prostat]");
  EXPECT_SAYS(error.what, "no region 'prostat' (there are: body, prostate, pubic_arch)");
  EXPECT_SAYS(error.cure, "Did you mean 'prostate'?");
}

TEST(ModelRefuses, a_held_region_that_is_not_there_and_names_the_nearest) {
  Scenario s = box_scenario();
  s.fixed.regions = {"pubicarch"};
  const Error error = refused(s);
  EXPECT_EQ(error.where, "case.toml, fixed.regions");
  EXPECT_SAYS(error.what, "'pubicarch'");
  EXPECT_SAYS(error.cure, "'pubic_arch'");
}

TEST(ModelRefuses, tissue_that_nothing_holds) {
  Scenario s = box_scenario();
  s.fixed.outer = OuterSupport::none;
  const Error error = refused(s, box_patient(false));
  EXPECT_EQ(error.where, "case.toml, [fixed]");
  EXPECT_SAYS(error.what, "nothing holds the tissue");
  EXPECT_SAYS(error.cure, "sides");
}

TEST(ModelRefuses, a_target_deeper_than_the_needle_reaches) {
  Scenario s = box_scenario();
  s.needle.length_mm = 30.0;
  const Error error = refused(s);
  EXPECT_SAYS(error.where, "insertion[0]");
  EXPECT_SAYS(error.what, "the needle is 30 mm long");
  EXPECT_SAYS(error.cure, "needle.length_mm");
}

TEST(ModelRefuses, a_needle_left_in_before_the_next_one) {
  Scenario s = box_scenario();
  s.insertions.push_back(s.insertions[0]);
  s.insertions[0].retract = false;
  const Error error = refused(s);
  EXPECT_SAYS(error.what, "insertion[0].retract = false");
  EXPECT_SAYS(error.what, "insertion[1]");
}

TEST(ModelRefuses, a_recorded_motion_that_starts_inside_the_patient) {
  Scenario s = box_scenario();
  s.insertions[0] = {};
  s.insertions[0].motion = "motion.csv";
  const std::vector<MotionSample> motion{{0.0, pose_along({0, 0, 20.0 - s.needle.length_mm}, Vec3::UnitZ())},
                                         {1.0, pose_along({0, 0, 30.0 - s.needle.length_mm}, Vec3::UnitZ())}};
  const Error error = refused(s, box_patient(), {motion});
  EXPECT_SAYS(error.where, "insertion[0].motion");
  EXPECT_SAYS(error.what, "starts with the tip inside the patient, at (0.0, 0.0, 20.0) mm");
}

TEST(ModelRefuses, meshes_that_no_simulation_may_use) {
  const auto message = [](auto&& spoil) {
    TetMesh mesh = box_patient();
    spoil(mesh);
    const Error error = refused(box_scenario(), std::move(mesh));
    EXPECT_SAYS(error.where, "box");
    return error.message();
  };
  EXPECT_SAYS(message([](TetMesh& m) { std::swap(m.tets[7][0], m.tets[7][1]); }), "7");
  EXPECT_SAYS(message([](TetMesh& m) { m.nodes[3].x() = std::nan(""); }), "3");
  EXPECT_SAYS(message([](TetMesh& m) { m.nodes.emplace_back(0, 0, 70); }), "343");
  message([](TetMesh& m) { m.tets.push_back(m.tets.front()), m.tet_region.push_back(0); });
  message([](TetMesh& m) {
    for (Vec3& x : m.nodes) x *= 1e-3;
  });
  message([](TetMesh& m) {
    for (Vec3& x : m.nodes) x *= 1e3;
  });
}

// Planned insertions.

TEST(Planning, a_hole_is_a_line_along_superior_with_D4_in_front_of_the_glands_centre) {
  Scenario s = box_scenario();
  s.insertions.assign(3, InsertionPlan{});
  s.insertions[0].hole = "D4";
  s.insertions[1].hole = "d4";  // the next column towards the patient's left
  s.insertions[2].hole = "D4.5";
  const auto model = compiled(s);
  const auto& planned = model->insertions();
  EXPECT_NEAR((planned[0].entry - Vec3(0, 5, 0)).norm(), 0.0, 2.0) << "the gland's centroid, to the elements' size";
  EXPECT_NEAR((planned[1].entry - planned[0].entry - Vec3(5, 0, 0)).norm(), 0.0, 1e-9) << "left is +x";
  EXPECT_NEAR((planned[2].entry - planned[0].entry - Vec3(0, -5, 0)).norm(), 0.0, 1e-9) << "anterior is -y";
  for (const auto& p : planned) EXPECT_EQ(p.direction, Vec3(Vec3::UnitZ()));
  EXPECT_EQ(planned[1].name, "hole d4");
}

TEST(Planning, the_templates_centre_can_be_given) {
  Scenario s = box_scenario();
  s.insertions[0] = {};
  s.insertions[0].hole = "E3";
  s.grid.centre_mm = {1.0, 2.0};
  EXPECT_NEAR((compiled(s)->insertions()[0].entry - Vec3(11, 12, 0)).norm(), 0.0, 1e-9);
}

TEST(Planning, the_entry_lies_on_the_skin_on_the_line_of_entry_and_direction) {
  Scenario s = box_scenario();
  s.insertions[0].direction = {0.3, -0.2, 2.0};
  const PlannedInsertion p = compiled(s)->insertions()[0];
  EXPECT_NEAR(p.entry.z(), 0.0, 1e-9);
  EXPECT_NEAR((p.direction - Vec3(0.3, -0.2, 2.0).normalized()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((p.entry - Vec3(4, 7, -20)).cross(p.direction).norm(), 0.0, 1e-9);
  EXPECT_EQ(p.name, "needle 1");
}

TEST(Planning, an_entry_point_behind_the_skin_still_means_the_line_from_outside) {
  Scenario s = box_scenario();
  s.insertions[0].entry_mm = {4.0, 7.0, 30.0};
  EXPECT_NEAR((compiled(s)->insertions()[0].entry - Vec3(4, 7, 0)).norm(), 0.0, 1e-9);
}

TEST(Planning, a_target_point_gives_the_direction) {
  Scenario s = box_scenario();
  s.insertions[0].target_mm = {0.0, 5.0, 30.0};
  const PlannedInsertion p = compiled(s)->insertions()[0];
  EXPECT_NEAR((p.direction - Vec3(-4, -2, 50).normalized()).norm(), 0.0, 1e-12);
}

TEST(Planning, without_a_depth_the_needle_goes_to_just_before_the_glands_far_end) {
  const auto model = compiled(box_scenario());
  const PlannedInsertion p = model->insertions()[0];
  const int gland = model->mesh().region_index("prostate");
  const auto region_at = [&](double depth) {
    const auto at = model->locator().find(p.entry + depth * p.direction);
    return at ? model->mesh().tet_region[static_cast<std::size_t>(at->tet)] : -1;
  };
  EXPECT_EQ(region_at(p.depth_mm), gland);
  EXPECT_EQ(region_at(p.depth_mm + 1.0), gland);
  for (double beyond = p.depth_mm + 3.0; beyond < 60.0; beyond += 0.5) EXPECT_NE(region_at(beyond), gland) << beyond;
}

TEST(Planning, a_given_depth_is_taken_as_it_is) {
  Scenario s = box_scenario();
  s.insertions[0].depth_mm = 21.5;
  const PlannedInsertion p = compiled(s)->insertions()[0];
  EXPECT_EQ(p.depth_mm, 21.5);
  const Pose deepest = p.motion.at(24.5 / 40.0);
  EXPECT_NEAR((deepest.origin + 120.0 * (deepest.rotation * Vec3::UnitZ()) - Vec3(4, 7, 21.5)).norm(), 0.0, 1e-9);
}

TEST(Planning, the_target_is_the_gland_or_its_zones_or_a_planning_volume_or_the_labels) {
  const auto targets = [](std::vector<std::string> names) {
    TetMesh mesh = box_patient();
    mesh.regions = std::move(names);
    Scenario s = box_scenario();
    s.fixed.outer = OuterSupport::all;
    std::vector<std::string> found;
    const auto model = compiled(s, mesh);
    for (const int region : model->target_regions())
      found.push_back(model->mesh().regions[static_cast<std::size_t>(region)]);
    return found;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(targets({"body", "prostate", "ptv"}), Names{"prostate"});
  EXPECT_EQ(targets({"body", "transition_zone", "anterior_stroma"}), (Names{"transition_zone", "anterior_stroma"}));
  EXPECT_EQ(targets({"body", "ptv", "ctv"}), Names{"ctv"});
  EXPECT_EQ(targets({"body", "label_1", "label_2"}), (Names{"label_1", "label_2"}));
  EXPECT_EQ(targets({"body", "liver", "rectum"}), Names{});
}

// Laws and parameters.

TEST(ModelLaws, are_those_of_the_scenario_in_mm_and_N) {
  Scenario s = box_scenario();
  s.tissue["prostate"] = default_tissue("prostate");
  s.tissue["prostate"].young_kPa = 50.0;
  s.tissue["prostate"].friction_static_N_per_m = 20.0;
  s.tissue["prostate"].friction_coulomb_N_per_m = 11.0;
  const auto model = compiled(s);
  const auto gland = static_cast<std::size_t>(model->mesh().region_index("prostate"));
  EXPECT_DOUBLE_EQ(model->tissue().material(static_cast<int>(gland)).young_MPa, 0.05);
  EXPECT_DOUBLE_EQ(model->laws()[gland].friction.static_N_per_mm, 0.020);
  EXPECT_DOUBLE_EQ(model->laws()[gland].friction.coulomb_N_per_mm, 0.011);
  EXPECT_DOUBLE_EQ(model->laws()[gland].friction.viscous_Ns_per_mm2, 250e-6);
  EXPECT_EQ(model->laws()[gland].puncture_N, default_tissue("prostate").puncture_N);
  EXPECT_TRUE(model->laws()[0].surrounding);
  EXPECT_FALSE(model->laws()[gland].rigid);
  EXPECT_TRUE(model->laws()[2].rigid);
}

TEST(ModelLaws, no_membrane_lies_between_the_gland_its_zones_and_the_urethra) {
  TetMesh mesh = box_patient();
  mesh.regions = {"body", "transition_zone", "urethra"};
  Scenario s = box_scenario();
  s.fixed.outer = OuterSupport::all;
  const auto model = compiled(s, mesh);
  EXPECT_EQ(membrane_force(model->laws(), 1, 2), 0.0);
  EXPECT_EQ(membrane_force(model->laws(), 2, 1), 0.0);
  EXPECT_EQ(membrane_force(model->laws(), 0, 1), default_tissue("transition_zone").puncture_N);
  EXPECT_EQ(membrane_force(model->laws(), 0, 2), 0.0) << "nor around the urethra outside the gland";
}

TEST(Tenting, is_that_of_a_flat_punch_on_a_half_space) {
  TissueParameters t = default_tissue("body");
  t.young_kPa = 17.0;
  t.poisson = 0.45;
  t.stiffening = 0.0;
  // F (1 − ν²) / (2 R E) = 2.3 · 0.7975 / (1.27 · 0.017)
  EXPECT_NEAR(tenting_mm(t, 2.3, 1.27), 84.96, 0.01);
}

TEST(CuttingLag, is_that_of_the_end_of_a_rod_deep_in_tissue) {
  TissueParameters t = default_tissue("prostate");
  t.stiffening = 0.0;
  for (const double diameter : {0.8, 1.27}) {
    // Stiffness 3.61 E R, computed with finite elements (tests/reference/rod_end.py --alone).
    const double rod_end = 3.61 * t.young_kPa * 1e-3 * 0.5 * diameter;
    EXPECT_NEAR(cutting_lag_mm(t, 0.5, diameter) * rod_end / 0.5, 1.0, 0.02) << diameter;
  }
}

TEST(Tenting, and_lag_of_tissue_that_stiffens_are_its_linear_far_field_and_a_parabola) {
  TissueParameters t = default_tissue("body");
  constexpr double diameter = 1.27;
  const double young_MPa = t.young_kPa * 1e-3;
  // Compliance to the same force spread over 10 mm, which is the linear part in any tissue: a Kelvinlet inside the
  // tissue, twice that on a surface.
  const double spread =
      (5.0 - 6.0 * t.poisson) * (1.0 + t.poisson) / (8.0 * std::numbers::pi * young_MPa * (1.0 - t.poisson) * 10.0);
  for (const double stiffening : {0.1, 0.5, 2.0}) {
    for (const double force : {0.3, 1.0, 3.0}) {
      for (const bool inside : {false, true}) {
        const auto depth = [&](double kappa) {
          t.stiffening = kappa;
          return inside ? cutting_lag_mm(t, force, diameter) : tenting_mm(t, force, diameter);
        };
        const double far = (inside ? spread : 2.0 * spread) * force;
        const double linear = depth(0.0) - far;
        const double dent = depth(stiffening) - far;
        EXPECT_NEAR(force * dent / linear + stiffening * young_MPa * dent * dent, force, 1e-9 * force);
        EXPECT_LT(dent, linear);
      }
    }
  }
}

TEST(Tenting, out_of_range_is_warned_of_with_its_numbers) {
  TissueParameters t = default_tissue("prostate", TissuePreset::linear);
  t.puncture_N = 3.0;
  auto warnings = tenting_warnings("prostate", t, 1.27);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_SAYS(warnings[0], "tissue.prostate");
  EXPECT_SAYS(warnings[0], "puncture_N = 3 ");
  EXPECT_SAYS(warnings[0], "young_kPa = 40 ");
  EXPECT_SAYS(warnings[0], "47.1 mm of tenting");
  t = default_tissue("prostate", TissuePreset::linear);
  t.puncture_N = 0.15;
  EXPECT_EQ(tenting_warnings("prostate", t, 1.27).size(), 1u) << "2.4 mm is too little";
  t.puncture_N = 0.0;
  EXPECT_TRUE(tenting_warnings("prostate", t, 1.27).empty()) << "no membrane, no tenting";
  t.cutting_N = 1.0;
  warnings = tenting_warnings("prostate", t, 1.27);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_SAYS(warnings[0], "cutting_N = 1 ");
  EXPECT_SAYS(warnings[0], "10.8 mm");
}

TEST(Tenting, of_defaults_gives_no_warning_and_of_a_held_region_none_either) {
  const auto about_tenting = [](const Model& model) {
    const auto& all = model.warnings();
    return std::count_if(all.begin(), all.end(), [](const std::string& warning) {
      return warning.find("Change them together") != std::string::npos;
    });
  };
  Scenario s = box_scenario();
  EXPECT_TRUE(compiled(s)->warnings().empty());
  s.tissue["pubic_arch"] = default_tissue("pubic_arch");
  s.tissue["pubic_arch"].puncture_N = 50.0;
  EXPECT_EQ(about_tenting(*compiled(s)), 0) << "bone is not punctured";
  s.tissue["prostate"] = default_tissue("prostate");
  s.tissue["prostate"].puncture_N = 30.0;
  const auto model = compiled(s);
  EXPECT_EQ(about_tenting(*model), 1);
  EXPECT_EQ(model->info().warnings, model->warnings());
}

TEST(RunInfo, says_of_every_parameter_whether_it_is_the_scenarios_or_where_it_comes_from) {
  Scenario s = box_scenario();
  s.tissue["prostate"] = default_tissue("prostate");
  s.tissue["prostate"].young_kPa = 50.0;
  s.coupling.spacing_mm = 5.0;
  const RunInfo info = compiled(s)->info();
  const auto row = [&](const std::string& name) {
    const auto found = std::find_if(info.parameters.begin(), info.parameters.end(),
                                    [&](const ParameterRow& p) { return p.name == name; });
    EXPECT_NE(found, info.parameters.end()) << name;
    return found == info.parameters.end() ? ParameterRow{} : *found;
  };
  EXPECT_EQ(row("tissue.prostate.young_kPa").source, "scenario");
  EXPECT_EQ(row("tissue.prostate.young_kPa").value, "50");
  EXPECT_EQ(row("tissue.prostate.young_kPa").unit, "kPa");
  EXPECT_EQ(row("tissue.prostate.puncture_N").source, default_tissue("prostate").source);
  EXPECT_EQ(row("tissue.pubic_arch").value, "held");
  EXPECT_EQ(row("needle.length_mm").source, "scenario");
  EXPECT_EQ(row("needle.length_mm").value, "120");
  EXPECT_EQ(row("needle.diameter_mm").source, "18 gauge");
  EXPECT_EQ(row("needle.bending_stiffness_Nmm2").value, "15722");
  EXPECT_SAYS(row("needle.bending_stiffness_Nmm2").source, "1 mm inner diameter, E 200 GPa");
  EXPECT_EQ(row("coupling.spacing_mm").source, "scenario");
  EXPECT_EQ(row("coupling.spacing_mm").unit, "mm");
  EXPECT_NE(row("coupling.grazing_deg").source, "scenario");
  EXPECT_EQ(row("run.dt_ms").source, "scenario");
  EXPECT_EQ(info.method, "near-field");
  EXPECT_EQ(info.target_regions, std::vector<int>{1});
  EXPECT_NEAR((info.entry_mm - Vec3(4, 7, 0)).norm(), 0.0, 1e-9);
  for (const ParameterRow& p : info.parameters) EXPECT_FALSE(p.source.empty()) << p.name;
}
