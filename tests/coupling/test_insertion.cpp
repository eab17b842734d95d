// SPDX-License-Identifier: GPL-3.0-or-later
// A whole insertion: the events, their order, and the laws that the forces obey.
#include "needle_in_block.hpp"

using namespace stylet;
using namespace stylet::test;
using Kind = EventKind;

TEST(Insertion, skin_contact_puncture_capsule_and_withdrawal_happen_in_order) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(55);
  run.go(-1);
  ASSERT_EQ(run.flags, 0u);
  std::vector<std::pair<Kind, int>> kinds;
  for (const Happened& h : run.happened) kinds.emplace_back(h.kind, h.region);
  const std::vector<std::pair<Kind, int>> expected{{Kind::skin_contact, 0},   {Kind::puncture, 0},
                                                   {Kind::region_entered, 0}, {Kind::puncture, 1},
                                                   {Kind::region_entered, 1}, {Kind::withdrawn, -1}};
  EXPECT_EQ(kinds, expected);
  // The skin breaks at its own threshold, because nothing else holds the needle then.
  EXPECT_NEAR(run.first(Kind::puncture, 0)->force, 1.0, 0.06);
}

TEST(Insertion, steady_cutting_force_is_cutting_plus_friction_along_the_shaft) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(20, 10.0);
  // Cutting 0.35 N + (11 N/m + 250 N s/m² × 10 mm/s) × 20 mm + tip viscosity 2 N s/m × 10 mm/s. The tip lags behind the
  // base by the distance that it pushes the tissue ahead, so the inserted length is a little less than the depth.
  EXPECT_NEAR(run.report.inserted_mm, 20.0, 5.0);
  const double friction = (11e-3 + 250e-6 * 10.0) * run.report.inserted_mm;
  EXPECT_NEAR(run.forces.back(), 0.35 + 0.02 + friction, 0.01);
}

TEST(Insertion, reversal_sticks_first_then_slips_and_the_force_changes_sign) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(50);
  const double pushing = run.forces.back();
  ASSERT_GT(pushing, 0.8);
  run.go(49.5);
  EXPECT_LT(run.report.sliding_share, 0.5) << "the tissue follows the needle at first";
  EXPECT_GT(run.report.sticking, 6);
  run.go(45);
  EXPECT_EQ(run.report.sliding_share, 1.0);
  EXPECT_LT(run.forces.back(), -0.5);
  EXPECT_EQ(run.report.tip_state, TipState::in_track);
}

TEST(Insertion, no_cutting_on_the_track_until_the_deepest_point_is_passed) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(40, 10.0);
  const double cutting = run.forces.back();
  run.go(30, 10.0);
  const double deepest = run.insertion->track().end_xi;
  run.go(20, 10.0);
  run.go(35, 10.0);
  EXPECT_EQ(run.report.tip_state, TipState::in_track);
  EXPECT_EQ(run.insertion->track().end_xi, deepest);
  // Friction over 35 mm at 10 mm/s, and no force of the tip.
  EXPECT_NEAR(run.forces.back(), (11e-3 + 2.5e-3) * 35.0, 0.03);
  run.go(40, 10.0);
  run.go(42, 10.0);
  EXPECT_EQ(run.report.tip_state, TipState::cutting);
  EXPECT_GT(run.insertion->track().end_xi, deepest + 1.0);
  EXPECT_NEAR(run.forces.back(), cutting + 2.0 * 13.5e-3, 0.03);
}

TEST(Insertion, full_withdrawal_resets_the_tissue_exactly) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(50);
  EXPECT_GT(run.insertion->displacement().cwiseAbs().maxCoeff(), 0.1);
  EXPECT_GT(run.insertion->compliance().points(), 5);
  run.go(-1);
  ASSERT_EQ(run.count(Kind::withdrawn), 1);
  EXPECT_EQ(run.insertion->displacement().cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(run.insertion->compliance().points(), 1);
  EXPECT_EQ(run.forces.back(), 0.0);

  // A second insertion at another place is like the first.
  NeedleInBlock fresh;
  for (NeedleInBlock* r : {&run, &fresh}) {
    r->forces.clear();
    r->aim({-9, 7, 0});
    r->go(50);
  }
  ASSERT_EQ(run.forces.size(), fresh.forces.size());
  double difference = 0.0;
  for (std::size_t i = 0; i < run.forces.size(); ++i)
    difference = std::max(difference, std::abs(run.forces[i] - fresh.forces[i]));
  EXPECT_LT(difference, 1e-9);
}

TEST(Insertion, hand_force_and_torque_balance_the_contacts_and_the_supports) {
  for (const auto rule : {CouplingSettings::Rule::interior, CouplingSettings::Rule::paper}) {
    BlockOptions options;
    options.coupling.rule = rule;
    NeedleInBlock run(options);
    run.aim({3, 2, 0}, Vec3(0.1, 0.05, 1.0));
    run.go(45);
    run.sideways = Vec3(0.8, -0.5, 0.0);
    run.step(1e-3);
    Vec3 force = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    const Vec3 base = run.insertion->needle().base().origin;
    for (const ContactState& c : run.insertion->contacts()) {
      force += c.force;
      torque += (run.insertion->needle().point(c.s) - base).cross(c.force);
    }
    EXPECT_LT((force - run.report.hand_force_N).norm(), 1e-9 * force.norm());
    EXPECT_LT((torque - run.report.torque_Nmm).norm(), 1e-9 * torque.norm());
    // The supports feel the needle only through the tissue.
    const VecX u = run.insertion->displacement();
    const VecX support = run.tissue->support_forces(u);
    Vec3 held = Vec3::Zero();
    for (Index node = 0; node < run.tissue->mesh().node_count(); ++node) {
      held += support.segment<3>(3 * node);
    }
    EXPECT_LT((held + force).norm(), 1e-9 * force.norm());
  }
}

TEST(Insertion, the_hand_puts_in_at_least_the_energy_that_is_stored) {
  NeedleInBlock run;
  run.aim({3, 2, 0}, Vec3(0.05, 0.1, 1.0));
  const auto stored = [&] { return run.insertion->tissue_energy() + run.insertion->needle().energy(); };
  for (const double to : {10.0, 20.0, 35.0, 50.0, 30.0, 45.0, 60.0, 20.0}) {
    run.go(to);
    EXPECT_GE(run.work + 1e-6, stored()) << "depth " << to;
  }
  EXPECT_GT(stored(), 0.0);
}

TEST(Insertion, laying_and_dropping_contacts_moves_the_base_force_by_less_than_a_thousandth_of_its_peak) {
  using Method = CouplingSettings::Method;
  for (const auto& [method, stiffening_MPa] :
       {std::pair{Method::near_field, 0.0}, std::pair{Method::near_field, 0.1}, std::pair{Method::node_addition, 0.0},
        std::pair{Method::embedded, 0.0}}) {
    BlockOptions options;
    options.coupling.method = method;
    options.laws[0].stiffening_MPa = stiffening_MPa;
    options.region_at = [](const Vec3&) { return 0; };  // no capsule: its puncture would add a jump
    NeedleInBlock run(options);
    run.aim({3, 2, 0}, Vec3(0.1, 0.05, 1.0));
    run.go(30);
    run.sideways = Vec3(0.6, 0.3, 0.0);  // for lateral forces as well
    run.wait(0.01);
    run.go(60);
    run.wait(0.02);
    run.go(5);
    const double peak = run.peak();
    double worst = 0.0;
    int changes = 0;
    for (std::size_t i = 3; i + 2 < run.forces.size(); ++i) {
      if (run.contact_counts[i] == run.contact_counts[i - 1] || run.depths[i] < 8.0) continue;
      const double here = run.forces[i] - run.forces[i - 1];
      const double around = 0.5 * (run.forces[i - 1] - run.forces[i - 2] + run.forces[i + 1] - run.forces[i]);
      if (std::abs(run.depths[i] - run.depths[i - 1]) < 1e-9) continue;
      worst = std::max(worst, std::abs(here - around));
      ++changes;
    }
    EXPECT_GT(changes, 15);
    EXPECT_LT(worst, 1e-3 * peak) << changes << " changes, peak " << peak;
  }
}

TEST(Insertion, moved_turned_and_mirrored_scene_gives_the_same_forces_in_its_frame) {
  BlockOptions plain;
  NeedleInBlock reference(plain);
  const Vec3 through(3, 2, 0);
  const Vec3 axis = Vec3(0.1, 0.05, 1.0).normalized();
  const auto drive = [&](NeedleInBlock& run, const Vec3& side) {
    run.go(40);
    run.sideways = side;
    run.step(1e-3);
    run.go(50);
    run.go(20);
  };
  reference.aim(through, axis);
  drive(reference, {0.5, 0.2, 0.0});
  const Vec3 expected = reference.report.hand_force_N;
  const Vec3 expected_torque = reference.report.torque_Nmm;

  Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Mat3 mirror = Mat3::Identity();
  mirror(0, 0) = -1;
  for (const Mat3& map : {turn, mirror, Mat3(turn * mirror)}) {
    const Vec3 shift(120, -40, 33);
    BlockOptions moved = plain;
    moved.edit = [&](TetMesh& mesh) {
      for (Vec3& x : mesh.nodes) x = map * x + shift;
      if (map.determinant() < 0) {
        for (auto& tet : mesh.tets) std::swap(tet[2], tet[3]);
      }
    };
    moved.held = [&](const Vec3& y) { return plain.held(map.transpose() * (y - shift)); };
    NeedleInBlock run(moved);
    run.aim(map * through + shift, map * axis);
    drive(run, map * Vec3(0.5, 0.2, 0.0));
    ASSERT_EQ(run.forces.size(), reference.forces.size());
    double difference = 0.0;
    for (std::size_t i = 0; i < run.forces.size(); ++i)
      difference = std::max(difference, std::abs(run.forces[i] - reference.forces[i]));
    EXPECT_LT(difference, 1e-8 * reference.peak());
    EXPECT_LT((run.report.hand_force_N - map * expected).norm(), 1e-8 * reference.peak());
    EXPECT_LT((run.report.torque_Nmm - map.determinant() * (map * expected_torque)).norm(),
              1e-7 * expected_torque.norm());
  }
}

TEST(Insertion, force_does_not_depend_on_the_time_step) {
  // Stick and slip: in, pause, out, in again. Compared at the same places of the base.
  const auto curve = [](double dt) {
    NeedleInBlock run;
    run.aim({3, 2, 0});
    std::vector<double> samples;
    const auto sweep = [&](double to) {
      const double from = run.depth;
      const int pieces = 40;
      for (int i = 1; i <= pieces; ++i) {
        run.go(from + (to - from) * i / pieces, 20.0, dt);
        samples.push_back(run.forces.back());
      }
    };
    sweep(39);
    sweep(19);
    sweep(39);
    sweep(15);
    return std::make_pair(samples, run.peak());
  };
  const auto [fine, peak] = curve(0.25e-3);
  for (const double dt : {0.5e-3, 1e-3, 2e-3}) {
    const auto samples = curve(dt).first;
    double sum = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) sum += (samples[i] - fine[i]) * (samples[i] - fine[i]);
    const double rms = std::sqrt(sum / static_cast<double>(samples.size()));
    EXPECT_LT(rms, 0.01 * peak) << "dt " << dt;
  }
}

TEST(Insertion, what_the_usual_tolerance_leaves_does_not_add_up) {
  const auto forces = [](double tolerance) {
    BlockOptions options;
    options.coupling.tolerance = tolerance;
    NeedleInBlock run(options);
    run.aim({4, 11, 0});
    for (const double to : {24.0, 20.0, 27.0, 12.0}) run.go(to);
    EXPECT_EQ(run.flags, 0u);
    return std::pair(run.forces, run.peak());
  };
  const auto [usual, peak] = forces(CouplingSettings{}.tolerance);
  const auto [exact, exact_peak] = forces(1e-12);
  ASSERT_EQ(usual.size(), exact.size());
  for (std::size_t k = 0; k < usual.size(); ++k) ASSERT_NEAR(usual[k], exact[k], 1e-7 * peak) << "step " << k;
}

TEST(Insertion, contacts_denser_than_elements_do_not_make_the_system_singular) {
  for (const auto method : {CouplingSettings::Method::near_field, CouplingSettings::Method::node_addition,
                            CouplingSettings::Method::embedded}) {
    for (const auto rule : {CouplingSettings::Rule::interior, CouplingSettings::Rule::paper}) {
      BlockOptions options;
      options.cells = {3, 3, 3};  // elements of 33 mm
      options.coupling.method = method;
      options.coupling.rule = rule;
      options.coupling.spacing_mm = 1.3;
      NeedleInBlock run(options);
      run.aim({3, 2, 0}, Vec3(0.05, 0.02, 1.0));
      run.go(60);
      run.sideways = Vec3(2, 1, 0);
      run.wait(0.05);
      run.go(-1);
      EXPECT_EQ(run.flags & ~unsigned(Step::out_of_contacts), 0u);
      EXPECT_EQ(run.count(Kind::withdrawn), 1);
      EXPECT_LT(run.peak(), 4.0);
    }
  }
}

TEST(Insertion, friction_turns_round_with_the_motion_at_any_speed_and_without_viscosity_too) {
  for (const auto solver : {CouplingSettings::Solver::coupled, CouplingSettings::Solver::staggered}) {
    for (const double speed : {20.0, 0.2}) {
      for (const double viscosity : {0.0, 1e-10, 250e-6}) {
        SCOPED_TRACE(testing::Message() << speed << " mm/s, " << viscosity << " N s/mm²");
        BlockOptions options;
        options.coupling.solver = solver;
        for (RegionLaws& laws : options.laws) laws.friction.viscous_Ns_per_mm2 = viscosity;
        NeedleInBlock run(options);
        run.aim({4, 11, 0});
        run.go(20, 40, 4e-3);
        EXPECT_GT(run.forces.back(), 0.3);
        run.go(16, speed, 0.08 / speed);
        // All of the shaft that is still in the tissue slides out: Coulomb friction on about 16 mm, and a little more.
        EXPECT_LT(run.forces.back(), -0.9 * 11e-3 * 16.0);
        EXPECT_GT(run.forces.back(), -0.4);
        EXPECT_EQ(run.flags, 0u);
      }
    }
  }
}
