// SPDX-License-Identifier: GPL-3.0-or-later
// Situations that need a decision; each test states the decision.
#include "needle_in_block.hpp"
#include "support/count_allocations.hpp"

#include <numbers>

using namespace stylet;
using namespace stylet::test;
using Kind = EventKind;

TEST(Situation, an_element_with_only_held_nodes_is_passed_without_a_singular_system) {
  for (const auto method : {CouplingSettings::Method::near_field, CouplingSettings::Method::node_addition,
                            CouplingSettings::Method::embedded}) {
    BlockOptions options;
    options.coupling.method = method;
    const auto sides = options.held;
    // All nodes within 15 mm of a point on the path are held, and yet this is soft tissue that can be cut.
    options.held = [sides](const Vec3& x) { return sides(x) || (x - Vec3(3, 2, 50)).norm() < 15.0; };
    NeedleInBlock run(options);
    run.aim({3, 2, 0}, Vec3(0.03, 0.02, 1.0));
    run.go(75);
    run.sideways = Vec3(1, 0, 0);
    run.wait(0.02);
    run.go(-1);
    EXPECT_EQ(run.flags, 0u);
    EXPECT_EQ(run.count(Kind::withdrawn), 1);
  }
}

TEST(Situation, a_path_through_nodes_edges_and_faces_is_followed_by_the_direction_of_travel) {
  // Without jitter the line x = y = 0 runs along edges and through nodes; x = 0, y = 3 runs inside faces.
  for (const Vec3& through : {Vec3(0, 0, 0), Vec3(0, 3, 0), Vec3(12.5, 12.5, 0)}) {
    for (const auto rule : {CouplingSettings::Rule::interior, CouplingSettings::Rule::paper}) {
      BlockOptions options;
      options.jitter = 0.0;
      options.coupling.rule = rule;
      options.region_at = [](const Vec3& x) {
        return x.z() > 25 && x.z() < 75 ? 1 : 0;
      };  // interfaces exactly on element faces
      NeedleInBlock run(options);
      run.aim(through);
      run.go(60);
      EXPECT_EQ(run.flags, 0u) << through.transpose();
      EXPECT_EQ(run.count(Kind::puncture, 1), 1) << through.transpose();
      EXPECT_EQ(run.count(Kind::region_entered, 1), 1) << through.transpose();
      run.go(-1);
      EXPECT_EQ(run.count(Kind::withdrawn), 1) << through.transpose();
    }
  }
}

TEST(Situation, a_grazing_needle_slides_off_without_a_puncture) {
  NeedleInBlock run;
  run.aim({-20, 0, 0}, Vec3(1.0, 0.0, 0.1), -3.0);  // 84° from the normal
  run.go(8.0);
  EXPECT_GE(run.count(Kind::grazed), 1);
  EXPECT_EQ(run.count(Kind::puncture), 0);
  EXPECT_EQ(run.count(Kind::skin_contact), 0);
  EXPECT_EQ(run.peak(), 0.0);
  EXPECT_EQ(run.report.flags, unsigned(Step::no_contact_inside)) << "no force, and it says so";
}

TEST(Situation, a_needle_leaves_through_the_far_side_and_comes_back) {
  BlockOptions options;
  options.hi = Vec3(50, 50, 40);
  options.cells = {8, 8, 4};
  options.region_at = [](const Vec3&) { return 0; };
  options.held = [](const Vec3& x) { return std::abs(x.x()) > 49.9 || std::abs(x.y()) > 49.9; };
  NeedleInBlock run(options);
  run.aim({3, 2, 0});
  run.go(38);
  const double inside = run.forces.back();
  run.go(60);
  ASSERT_EQ(run.count(Kind::exited), 1);
  EXPECT_EQ(run.report.tip_state, TipState::exited);
  // Outside nothing is cut: only friction over the 40 mm inside remains, and the shaft contacts stay.
  EXPECT_NEAR(run.forces.back(), (11e-3 + 5e-3) * 40.0, 0.06);
  EXPECT_LT(run.forces.back(), inside + 0.05);
  EXPECT_NEAR(run.report.inserted_mm, 40.0, 1.5);
  run.go(30);
  EXPECT_EQ(run.count(Kind::re_entered), 1);
  EXPECT_EQ(run.report.tip_state, TipState::in_track);
  run.go(60);
  EXPECT_EQ(run.count(Kind::exited), 2);
  run.go(-1);
  EXPECT_EQ(run.count(Kind::withdrawn), 1);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Situation, an_entry_near_an_old_track_joins_it_and_one_further_off_does_not) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(40);
  run.go(-1);
  ASSERT_EQ(run.insertion->old_tracks().size(), 1u);
  run.happened.clear();
  run.forces.clear();
  run.aim({3.8, 2.3, 0});  // 0.85 mm beside: within the needle's diameter
  run.go(34);              // the track ends where the tip has cut, which is behind the base depth
  EXPECT_EQ(run.count(Kind::puncture), 0) << "the old track needs no puncture";
  EXPECT_EQ(run.report.tip_state, TipState::in_track);
  EXPECT_GT(run.report.contacts, 4);
  EXPECT_LT(run.peak(), 0.9);  // friction only
  run.go(45);
  EXPECT_EQ(run.report.tip_state, TipState::cutting);
  run.go(-1);
  EXPECT_EQ(run.insertion->old_tracks().size(), 1u);

  run.happened.clear();
  run.aim({5.0, 2.0, 0});  // 2 mm beside
  run.go(20);
  EXPECT_EQ(run.count(Kind::puncture, 0), 1);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Situation, a_track_joined_on_tilted_skin_begins_where_the_needle_met_the_skin) {
  for (const double tilt_deg : {2.0, 20.0, 50.0}) {
    SCOPED_TRACE(testing::Message() << tilt_deg << "° from the skin's normal");
    const double tilt = tilt_deg * std::numbers::pi / 180.0;
    const Vec3 axis(std::sin(tilt), 0.0, std::cos(tilt));
    for (const double beside : {0.6, -0.6}) {  // the old entry is behind the new one, or ahead of it
      NeedleInBlock run;
      run.aim({-10, 2, 0}, axis);
      run.go(25);
      run.go(-1);
      ASSERT_EQ(run.count(Kind::withdrawn), 1);
      const double end_xi = run.insertion->old_tracks()[0].end_xi;
      run.happened.clear();
      run.aim({-10 + beside, 2, 0}, axis);
      run.go(15);
      EXPECT_EQ(run.count(Kind::withdrawn), 0) << "no hand has drawn it out";
      EXPECT_EQ(run.count(Kind::puncture), 0);
      EXPECT_EQ(run.report.tip_state, TipState::in_track);
      EXPECT_GT(run.forces.back(), 0.05);
      const Track& track = run.insertion->track();
      EXPECT_LT((track.entry - Vec3(-10 + beside, 2, 0)).norm(), 1e-9);
      EXPECT_NEAR(track.end_xi, end_xi - beside * std::sin(tilt), 0.02);
      EXPECT_NEAR(run.report.inserted_mm, 15.0, 2.0);
      run.go(-1);
      EXPECT_EQ(run.count(Kind::withdrawn), 1);
      EXPECT_EQ(run.flags, 0u);
    }
  }
}

TEST(Situation, a_tip_placed_in_the_tissue_says_that_no_force_acts_on_it) {
  NeedleInBlock run;
  run.aim({3, 2, 0}, Vec3::UnitZ(), 10.0);
  run.go(20);
  EXPECT_EQ(run.report.tip_state, TipState::air);
  EXPECT_EQ(run.peak(), 0.0);
  EXPECT_EQ(run.report.flags, unsigned(Step::no_contact_inside));
  run.go(-1);
  EXPECT_EQ(run.report.flags, 0u);
  run.go(20);
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_EQ(run.count(Kind::puncture, 0), 1);
}

TEST(Situation, a_concave_organ_is_left_and_entered_again) {
  BlockOptions options;
  options.cells = {10, 10, 10};
  options.jitter = 0.0;
  // One organ with two lobes on the path.
  options.region_at = [](const Vec3& x) {
    return (x.z() > 20 && x.z() < 40) || (x.z() > 50 && x.z() < 70) || (x.x() > 20 && x.z() > 20 && x.z() < 70) ? 1 : 0;
  };
  NeedleInBlock run(options);
  run.aim({3, 2, 0});
  run.go(62);
  EXPECT_EQ(run.count(Kind::region_entered, 1), 2);
  EXPECT_EQ(run.count(Kind::puncture, 1), 2);
  EXPECT_EQ(run.count(Kind::region_entered, 0), 2);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Situation, a_wall_within_the_patient_is_broken_by_a_needle_nearly_along_it) {
  BlockOptions options;
  options.cells = {10, 10, 10};
  options.jitter = 0.0;
  options.region_at = [](const Vec3& x) { return x.x() > 0 ? 1 : 0; };
  NeedleInBlock run(options);
  run.aim({-1.5, 2, 0}, Vec3(std::sin(0.07), 0, std::cos(0.07)));  // 4° to the wall, which is flatter than skin lets a
                                                                   // needle in
  run.go(60);
  EXPECT_EQ(run.count(Kind::puncture, 1), 1);
  EXPECT_EQ(run.count(Kind::region_entered, 1), 1);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Situation, a_fold_of_skin_is_left_through_the_air_and_the_body_entered_again) {
  BlockOptions options;
  options.cells = {10, 10, 10};
  options.jitter = 0.0;
  options.region_at = [](const Vec3&) { return 0; };
  options.held = [](const Vec3& x) { return x.x() < -49.9; };
  options.edit = [](TetMesh& mesh) {  // cuts a notch: no tissue at x > −20 between z = 20 and z = 40
    TetMesh kept = mesh;
    kept.tets.clear();
    kept.tet_region.clear();
    for (Index t = 0; t < mesh.tet_count(); ++t) {
      Vec3 c = Vec3::Zero();
      for (const Index node : mesh.tets[static_cast<std::size_t>(t)])
        c += 0.25 * mesh.nodes[static_cast<std::size_t>(node)];
      if (c.x() > -20 && c.z() > 20 && c.z() < 40) continue;
      kept.tets.push_back(mesh.tets[static_cast<std::size_t>(t)]);
      kept.tet_region.push_back(mesh.tet_region[static_cast<std::size_t>(t)]);
    }
    std::vector<Index> number(mesh.nodes.size(), -1);
    kept.nodes.clear();
    for (auto& tet : kept.tets) {
      for (Index& node : tet) {
        if (number[static_cast<std::size_t>(node)] < 0) {
          number[static_cast<std::size_t>(node)] = static_cast<Index>(kept.nodes.size());
          kept.nodes.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
        }
        node = number[static_cast<std::size_t>(node)];
      }
    }
    mesh = kept;
  };
  NeedleInBlock run(options);
  run.aim({3, 2, 0});
  run.go(30);
  EXPECT_EQ(run.count(Kind::exited), 1);
  EXPECT_EQ(run.report.tip_state, TipState::exited);
  run.go(60);
  EXPECT_EQ(run.count(Kind::re_entered), 1);
  EXPECT_EQ(run.count(Kind::puncture, 0), 2);
  EXPECT_EQ(run.report.tip_state, TipState::cutting);
  run.go(-1);
  EXPECT_EQ(run.count(Kind::withdrawn), 1);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Situation, elements_smaller_than_the_needle_do_not_break_the_step) {
  BlockOptions options;
  options.lo = Vec3(-2, -2, 0);
  options.hi = Vec3(2, 2, 10);
  options.cells = {8, 8, 20};  // 0.5 mm, the needle's radius is 0.635 mm
  options.region_at = [](const Vec3&) { return 0; };
  options.laws[0].puncture_N = 0.1;  // this small block yields ten millimetres per newton
  options.laws[0].cutting_N = 0.05;
  options.held = [](const Vec3& x) { return std::abs(x.x()) > 1.9 || std::abs(x.y()) > 1.9 || x.z() > 9.9; };
  NeedleInBlock run(options);
  run.aim({0.2, 0.1, 0});
  run.go(8, 5.0);
  EXPECT_EQ(run.flags, 0u);
  EXPECT_GT(run.insertion->track().end_xi, 6.0);
  run.go(-1, 5.0);
  EXPECT_EQ(run.count(Kind::withdrawn), 1);
  EXPECT_LT(run.peak(), 2.0);
}

TEST(Situation, two_contacts_in_one_element_are_held_apart) {
  int cases = 0;
  for (int path = 0; path < 6; ++path) {
    BlockOptions options;
    options.cells = {3, 3, 3};
    options.coupling.spacing_mm = 2.0;
    NeedleInBlock run(options);
    run.aim({3.0 + 1.7 * path, 2.0 - 0.9 * path, 0});
    run.go(50);
    std::vector<Index> elements;
    for (const Track::Mark& mark : run.insertion->track().marks) elements.push_back(mark.at.tet);
    std::sort(elements.begin(), elements.end());
    cases += std::adjacent_find(elements.begin(), elements.end()) != elements.end() ? 1 : 0;
    EXPECT_EQ(run.flags, 0u);
    // Cutting takes 0.25 … 0.35 N, and friction at most 18 mN per mm of tributary length: no contact works against its
    // neighbour.
    for (const ContactState& c : run.insertion->contacts()) EXPECT_LT(c.force.norm(), 0.4 + 18e-3 * c.length);
  }
  EXPECT_GT(cases, 0) << "no path had two contacts in one element";
}

TEST(Situation, a_base_moved_sideways_while_stuck_bends_the_needle_and_drags_the_tissue) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(40);
  run.wait(0.2);
  const double axial = run.forces.back();
  run.sideways = Vec3(3, 0, 0);
  run.wait(0.01);
  EXPECT_GT(run.report.hand_force_N.x(), 0.01);
  const double free = 110.0;  // free length, from the clamped base to the skin
  EXPECT_LT(run.report.hand_force_N.x(), 12.0 * 15700 * 3.0 / (free * free * free) * 1.1)
      << "no stiffer than a clamped beam";
  EXPECT_GT(run.insertion->displacement().cwiseAbs().maxCoeff(), 0.02);
  run.sideways = Vec3::Zero();
  run.wait(0.01);
  EXPECT_NEAR(run.report.hand_force_N.x(), 0.0, 0.02);
  EXPECT_NEAR(run.forces.back(), axial, 0.1);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Situation, a_full_contact_list_is_flagged_and_the_run_goes_on) {
  BlockOptions options;
  options.coupling.capacity = 5;
  NeedleInBlock run(options);
  run.aim({3, 2, 0});
  run.go(50);
  EXPECT_TRUE(run.flags & Step::out_of_contacts);
  EXPECT_EQ(run.report.tip_state, TipState::cutting);
  run.go(-1);
  EXPECT_EQ(run.count(Kind::withdrawn), 1);
}

TEST(Situation, a_pose_that_is_not_finite_is_refused_and_the_last_state_kept) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(20);
  run.wait(0.2);
  const Vec3 force = run.report.hand_force_N;
  Pose bad = run.pose();
  bad.origin.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(run.insertion->step(bad, 1e-3).flags, unsigned(Step::invalid_input));
  EXPECT_EQ(run.insertion->step(run.pose(), 0.0).flags, unsigned(Step::invalid_input));
  run.step(1e-3);
  EXPECT_EQ(run.flags, 0u);
  EXPECT_LT((run.report.hand_force_N - force).norm(), 1e-3);
}

TEST(Situation, a_needle_placed_elsewhere_while_still_in_leaves_the_tissue_unloaded) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(30);
  run.aim({-15, 10, 0});
  EXPECT_EQ(run.insertion->displacement().cwiseAbs().maxCoeff(), 0.0);
  run.go(10);
  EXPECT_EQ(run.count(Kind::skin_contact), 2);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Situation, the_force_of_a_puncture_is_that_of_the_break_at_any_speed) {
  for (const double dt : {1e-3, 4e-3}) {
    NeedleInBlock run;
    run.aim({3, 2, 0});
    run.depth = -0.5;
    double force = 0.0;
    for (int k = 0; k < 400 && force == 0.0; ++k) {
      run.depth += 40.0 * dt;
      run.step(dt);
      for (const InsertionEvent& event : run.insertion->events()) {
        if (event.kind == Kind::puncture) force = event.force_N;
      }
    }
    EXPECT_NEAR(force, 1.0, 1e-3) << "dt " << dt;
  }
}

TEST(Situation, viscous_tissue_may_remember_more_points_than_a_needle_holds) {
  BlockOptions options;
  options.cells = {6, 6, 6};
  options.coupling.creep = {3.0, 1.0};
  options.coupling.capacity = 12;
  NeedleInBlock run(options);
  run.aim({2.0, 3.0, 0.0});
  run.go(35.0, 20.0, 2e-3);
  run.go(-2.0, 40.0, 2e-3);
  ASSERT_EQ(run.count(Kind::withdrawn), 1);
  run.go(35.0, 20.0, 2e-3);
  EXPECT_EQ(run.count(Kind::skin_contact), 2);
  EXPECT_GT(run.insertion->compliance().points(), options.coupling.capacity + 1);
}

TEST(Step, does_not_allocate_over_puncture_full_contact_and_retraction) {
  if (!AllocationCount::available()) GTEST_SKIP() << "the memory functions cannot be replaced under sanitizers";
  using Method = CouplingSettings::Method;
  using Rule = CouplingSettings::Rule;
  for (const auto& [method, rule] : {std::pair{Method::near_field, Rule::interior},
                                     {Method::node_addition, Rule::interior},
                                     {Method::node_addition, Rule::paper}}) {
    BlockOptions options;
    options.coupling.method = method;
    options.coupling.rule = rule;
    NeedleInBlock run(options);
    run.aim({3, 2, 0});
    long allocations = 0;
    int most_contacts = 0;
    std::size_t nodes_added = 0;
    unsigned flags = 0;
    for (int k = 0; k < 6500; ++k) {
      run.depth += k < 3250 ? 0.02 : -0.02;
      const Pose pose = run.pose();
      run.insertion->prepare(8.0);
      const AllocationCount counter;
      run.report = run.insertion->step(pose, 1e-3);
      allocations += counter.count();
      most_contacts = std::max(most_contacts, run.report.contacts);
      nodes_added = std::max(nodes_added, run.insertion->compliance().remeshing().size());
      flags |= run.report.flags;
    }
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(flags, 0u);
    EXPECT_GT(most_contacts, rule == Rule::paper ? 5 : 10);  // one at each face
    EXPECT_EQ(nodes_added > 0, method == Method::node_addition);
    EXPECT_EQ(run.report.tip_state, TipState::air);
  }
}
