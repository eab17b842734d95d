// SPDX-License-Identifier: GPL-3.0-or-later
// Compliance that is computed while the needle moves: the same values, bounded memory, and the behaviour without it.
#include "needle_in_block.hpp"
#include "support/count_allocations.hpp"

using namespace stylet;
using namespace stylet::test;
using Work = ComplianceSupply::Work;
using Kind = EventKind;

namespace {

constexpr std::size_t kAtOnce = 8;

ComplianceSupply::Settings near_the_tip() { return {.radius_mm = 8.0, .ahead_mm = 4.0}; }

/// Room for so few nodes that a needle at another place takes over the slots of the first.
constexpr Index kLittle = 150;
ComplianceSupply::Settings little_room() { return {.radius_mm = 3.0, .ahead_mm = 4.0, .spare_nodes = kLittle}; }
BlockOptions fine_block() {
  BlockOptions options;
  options.cells = {12, 12, 12};
  return options;
}

/// Steps without prepare(); the worker's side has a round after every `rounds_every`-th step.
struct WithWorker : NeedleInBlock {
  int rounds_every = 1;
  int flagged = 0;
  long taken = 0;

  explicit WithWorker(const BlockOptions& options = {}, const ComplianceSupply::Settings& settings = near_the_tip())
      : NeedleInBlock(options) {
    insertion->supply().open(settings);
  }

  void go_on(double to, double speed = 20.0, double dt = kStep_s) {
    const double way = to - depth;
    const double from = depth;
    const auto steps = std::max<long>(1, std::lround(std::abs(way) / (speed * dt)));
    for (long k = 1; k <= steps; ++k) {
      depth = from + way * static_cast<double>(k) / static_cast<double>(steps);
      one_step(dt);
    }
  }

  void one_step(double dt = kStep_s) {
    report = insertion->step(pose(), dt);
    forces.push_back(report.hand_force_N.dot(axis));
    flags |= report.flags;
    flagged += (report.flags & Step::compliance_missing) != 0 ? 1 : 0;
    for (const InsertionEvent& event : insertion->events()) {
      happened.push_back({event.kind, event.region, depth, event.force_N});
    }
    if (rounds_every > 0 && ++taken % rounds_every == 0) insertion->supply().work(kAtOnce);
  }

  /// Has rounds until no compliance is missing, while the needle stays at its place.
  void rest() {
    const int as_before = std::exchange(rounds_every, 0);
    Work last = Work::done;
    int idle = 0;  // after the step that took the last rows, the wanted place may be another one
    for (int k = 0; k < 1000 && idle < 2; ++k) {
      one_step();
      last = insertion->supply().work(kAtOnce);
      idle = last == Work::idle ? idle + 1 : 0;
    }
    EXPECT_EQ(last, Work::idle);
    one_step();
    rounds_every = as_before;
  }
};

}  // namespace

class ComplianceSupplyOf : public testing::TestWithParam<Element> {};
INSTANTIATE_TEST_SUITE_P(Elements, ComplianceSupplyOf,
                         testing::Values(Element::p1, Element::nodal_pressure, Element::p2));

TEST_P(ComplianceSupplyOf, rows_that_came_in_parcels_are_those_of_the_factor) {
  BlockOptions options;
  options.cells = {5, 5, 5};
  options.element = GetParam();
  WithWorker run(options);
  run.aim({3, 2, 0});
  run.go_on(60);
  const std::vector<Index> stored = run.store->stored();
  ASSERT_GT(stored.size(), 40u);
  ComplianceStore direct(run.tissue);
  direct.add_nodes(stored);
  for (const Index a : stored) {
    for (const Index b : stored) {
      const double scale = direct.block(a, a).norm() + direct.block(b, b).norm();
      EXPECT_LE((run.store->block(a, b) - direct.block(a, b)).norm(), 1e-12 * scale);
      EXPECT_EQ(run.store->block(a, b), run.store->block(b, a).transpose());
    }
  }
}

TEST(ComplianceSupply, a_worker_that_keeps_ahead_gives_the_same_forces) {
  WithWorker run;
  run.aim({3, 2, 0}, {0.05, 0.02, 1.0});
  run.rest();
  NeedleInBlock prepared;
  prepared.aim({3, 2, 0}, {0.05, 0.02, 1.0});
  prepared.wait(kStep_s * static_cast<double>(run.forces.size()));
  run.go_on(60, 5.0);
  prepared.go(60, 5.0);
  EXPECT_EQ(run.flags, 0u);
  ASSERT_EQ(run.forces.size(), prepared.forces.size());
  for (std::size_t k = 0; k < run.forces.size(); ++k) ASSERT_NEAR(run.forces[k], prepared.forces[k], 1e-7) << k;
}

TEST(ComplianceSupply, memory_is_bounded_and_no_contact_loses_its_compliance) {
  WithWorker run(fine_block(), little_room());
  // In and out at places far from each other, which together need far more nodes than there is room for.
  for (const Vec3& through : {Vec3(3, 2, 0), Vec3(-25, 20, 0), Vec3(24, -22, 0)}) {
    run.aim(through);
    run.rest();
    Index most = 0;
    for (const double depth : {30.0, 55.0, 20.0, 45.0}) {
      run.go_on(depth, 10.0, 2 * kStep_s);
      most = std::max(most, run.store->stored_nodes());
      for (const ContactState& contact : run.insertion->contacts()) EXPECT_TRUE(contact.force.allFinite());
    }
    EXPECT_LE(most, kLittle);
    run.go_on(-1.0, 20.0, 2 * kStep_s);
    EXPECT_EQ(run.flags, 0u);
  }
  EXPECT_EQ(run.count(Kind::withdrawn), 3);
}

TEST(ComplianceSupply, what_was_forgotten_comes_back_with_the_same_numbers) {
  WithWorker run(fine_block(), little_room());
  const auto insertion_at = [&](const Vec3& through) {
    run.aim(through);
    run.rest();
    run.go_on(40.0, 10.0, 2 * kStep_s);
    const double force = run.forces.back();
    run.go_on(-1.0, 20.0, 2 * kStep_s);
    return force;
  };
  EXPECT_GT(insertion_at({3, 2, 0}), 0.5);
  const auto of_the_first = run.store->stored();
  insertion_at({-25, 20, 0});
  insertion_at({24, -22, 0});
  EXPECT_TRUE(std::any_of(of_the_first.begin(), of_the_first.end(), [&](Index node) { return !run.store->has(node); }));
  // Beside the first track, so that the needle does not join it; and the same in a block that has given up no rows.
  const double again = insertion_at({3, 6, 0});
  WithWorker fresh(fine_block());
  fresh.aim({3, 6, 0});
  fresh.rest();
  fresh.go_on(40.0, 10.0, 2 * kStep_s);
  EXPECT_NEAR(again, fresh.forces.back(), 1e-6);
}

TEST(ComplianceSupply, an_outrun_needle_goes_on_with_the_last_row_is_flagged_and_recovers) {
  for (const auto method : {CouplingSettings::Method::near_field, CouplingSettings::Method::node_addition}) {
    BlockOptions options;
    options.coupling.method = method;
    NeedleInBlock prepared(options);
    prepared.aim({3, 2, 0});
    prepared.wait(0.1);
    prepared.go(60);

    WithWorker run(options);
    run.aim({3, 2, 0});
    run.rest();
    run.go_on(20);
    EXPECT_EQ(run.flags, 0u);
    run.rounds_every = 0;  // the worker stops
    run.go_on(60);
    EXPECT_EQ(run.flags, static_cast<unsigned>(Step::compliance_missing));
    EXPECT_NE(run.report.flags, 0u);
    EXPECT_EQ(run.report.tip_state, TipState::cutting) << "it is not held";
    EXPECT_GT(run.insertion->track().end_xi, 50.0);
    // The force neither jumps nor rises like at a wall: the last contact carries the friction of those that wait.
    const auto largest_jump = [](const std::vector<double>& forces) {
      double largest = 0.0;
      for (std::size_t k = 1; k < forces.size(); ++k) largest = std::max(largest, std::abs(forces[k] - forces[k - 1]));
      return largest;
    };
    EXPECT_LE(largest_jump(run.forces), 1.05 * largest_jump(prepared.forces));
    EXPECT_LE(run.peak(), 1.1 * prepared.peak());
    EXPECT_NEAR(run.forces.back(), prepared.forces.back(), 0.1 * prepared.forces.back());

    run.flags = 0;
    run.rest();
    EXPECT_EQ(run.report.flags, 0u);
    // A waiting contact that could have no node at its mark, and depends linearly on its neighbours, is dropped.
    EXPECT_GE(run.insertion->contacts().size() + 1, prepared.insertion->contacts().size());
    run.flags = 0;
    run.rounds_every = 1;
    run.go_on(65);
    prepared.go(65);
    EXPECT_EQ(run.flags, 0u);
    EXPECT_NEAR(run.forces.back(), prepared.forces.back(), 0.05 * prepared.forces.back());
  }
}

TEST(ComplianceSupply, an_outrun_needle_at_rest_gets_what_it_lacks_from_prepare) {
  NeedleInBlock run;
  run.aim({3, 2, 0});
  run.go(20);
  while (run.depth < 60.0) {
    run.depth += 0.02;
    run.report = run.insertion->step(run.pose(), 1e-3);
  }
  ASSERT_EQ(run.report.flags, static_cast<unsigned>(Step::compliance_missing));
  for (int k = 0; k < 50 && run.report.flags != 0; ++k) run.step(1e-3);  // prepare(), then a step
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_GT(run.insertion->contacts().size(), 12u);
}

TEST(ComplianceSupply, an_outrun_needle_that_left_through_the_far_side_gets_its_contacts) {
  BlockOptions options;
  options.hi = Vec3(50, 50, 40);
  options.cells = {8, 8, 4};
  options.held = [](const Vec3& x) { return std::abs(x.x()) > 49.9 || std::abs(x.y()) > 49.9; };
  options.region_at = [](const Vec3&) { return 0; };
  WithWorker run(options);
  run.aim({3, 2, 0});
  run.rest();
  run.go_on(8);
  run.rounds_every = 0;
  run.go_on(60);
  ASSERT_EQ(run.report.tip_state, TipState::exited);
  ASSERT_NE(run.report.flags, 0u);
  run.rest();
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_GE(run.insertion->contacts().size(), 9u);
  run.rounds_every = 1;
  run.go_on(-1);
  EXPECT_EQ(run.count(Kind::withdrawn), 1);
}

TEST(ComplianceSupply, an_old_track_that_was_forgotten_is_joined_all_the_same) {
  WithWorker run(fine_block(), little_room());
  const auto in_and_out = [&](const Vec3& through) {
    run.aim(through);
    run.rest();
    run.go_on(45.0, 20.0, 2 * kStep_s);
    run.go_on(-1.0, 20.0, 2 * kStep_s);
  };
  for (const Vec3& through : {Vec3(3, 2, 0), Vec3(-25, 20, 0), Vec3(24, -22, 0)}) in_and_out(through);
  ASSERT_EQ(run.flags, 0u);
  run.aim({3, 2, 0});
  run.rest();
  run.rounds_every = 0;
  run.go_on(50.0, 20.0, 2 * kStep_s);  // through the old track and beyond its end
  EXPECT_EQ(run.flags, static_cast<unsigned>(Step::compliance_missing));
  for (const double force : run.forces) ASSERT_TRUE(std::isfinite(force));
  run.rest();
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_GE(run.insertion->contacts().size(), 11u);
  EXPECT_EQ(run.count(Kind::puncture, 0), 3) << "not again";
}

TEST(ComplianceSupply, a_surface_met_without_compliance_is_entered_when_it_has_come) {
  WithWorker run;
  run.rounds_every = 0;
  run.aim({3, 2, 0});
  run.go_on(1.2);
  EXPECT_TRUE(run.report.flags & Step::compliance_missing);
  EXPECT_EQ(run.report.tip_state, TipState::air);
  EXPECT_EQ(run.peak(), 0.0);
  EXPECT_EQ(run.count(Kind::skin_contact), 0);
  run.rest();
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_EQ(run.count(Kind::skin_contact), 1);
  EXPECT_GT(run.forces.back(), 0.1) << "pressed in by as much as the needle is beyond the surface";
  run.rounds_every = 1;
  run.go_on(30);
  EXPECT_EQ(run.count(Kind::puncture, 0), 1);
}

TEST(ComplianceSupply, a_needle_far_inside_when_the_first_compliance_comes_is_to_be_drawn_out) {
  // If it pressed on the skin from that depth, its force would be that of a dent tens of millimetres deep.
  WithWorker run;
  run.rounds_every = 0;
  run.aim({3, 2, 0});
  run.go_on(30.0);
  run.rounds_every = 1;
  run.go_on(40.0);
  EXPECT_TRUE(run.report.flags & Step::compliance_missing);
  EXPECT_EQ(run.report.tip_state, TipState::air);
  run.go_on(-1.0);
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_EQ(run.peak(), 0.0);
  EXPECT_TRUE(run.happened.empty());

  run.go_on(30.0);
  WithWorker other;
  other.aim({3, 2, 0});
  other.rest();
  other.go_on(30.0);
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_EQ(run.count(Kind::puncture, 0), 1);
  EXPECT_NEAR(run.forces.back(), other.forces.back(), 1e-3 * other.forces.back());
}

TEST(ComplianceSupply, a_needle_that_went_past_the_skin_may_leave_sideways_and_enter_elsewhere) {
  WithWorker run;
  run.rounds_every = 0;
  run.aim({3, 2, 0});
  run.go_on(30.0);
  run.rounds_every = 1;
  while (run.sideways.x() < 80.0) {  // out through the side of the block
    run.sideways.x() += 0.1;
    run.one_step();
    if (run.sideways.x() < 45.0) {
      ASSERT_TRUE(run.report.flags & Step::compliance_missing);
    }
  }
  EXPECT_EQ(run.report.flags, 0u);
  EXPECT_EQ(run.peak(), 0.0);
  EXPECT_TRUE(run.happened.empty()) << "not grazed either, from within";
  run.go_on(-1.0);
  run.sideways.x() = -20.0;
  run.one_step();
  run.rest();
  run.go_on(30.0);
  EXPECT_EQ(run.count(Kind::puncture, 0), 1);
}

TEST(ComplianceSupply, what_came_beyond_the_rows_of_the_start_is_counted) {
  BlockOptions options = fine_block();
  options.coupling.spare_nodes = kLittle;
  WithWorker run(options, little_room());
  run.aim({3, 2, 0});
  run.rest();
  const int at_skin = run.insertion->capacities().spare_nodes.most;
  run.go_on(60.0);
  const CapacityUses& in_use = run.insertion->capacities();
  EXPECT_GT(at_skin, 0);
  EXPECT_GT(in_use.spare_nodes.most, at_skin);
  EXPECT_EQ(in_use.spare_nodes.room, kLittle);
  EXPECT_LE(in_use.spare_nodes.most, kLittle);
  EXPECT_EQ(in_use.contacts.most, static_cast<int>(run.insertion->contacts().size()) - 1) << "the tip is the other";
}

TEST(ComplianceSupply, a_needle_that_turns_away_before_it_entered_has_touched_nothing) {
  WithWorker run;
  run.rounds_every = 0;
  run.aim({3, 2, 0});
  run.go_on(2.0);
  run.go_on(-2.0);
  run.rest();
  EXPECT_EQ(run.count(Kind::skin_contact), 0);
  EXPECT_EQ(run.peak(), 0.0);
  EXPECT_EQ(run.report.flags, 0u);
}

TEST(ComplianceSupply, a_step_that_takes_rows_over_neither_allocates_nor_frees) {
  if (!AllocationCount::available()) GTEST_SKIP() << "the memory functions cannot be replaced under sanitizers";
  WithWorker run(fine_block(), little_room());
  run.aim({3, 2, 0});
  long allocations = 0;
  int parcels = 0;
  for (int k = 0; k < 6000; ++k) {
    run.depth += k < 3000 ? 0.02 : -0.02;
    const Pose pose = run.pose();
    parcels += run.insertion->supply().awaits_step() ? 1 : 0;
    {
      const AllocationCount counter;
      run.insertion->step(pose, 1e-3);
      allocations += counter.count();
    }
    run.insertion->supply().work(kAtOnce);
  }
  EXPECT_GT(parcels, 100);
  EXPECT_EQ(allocations, 0);
}
