// SPDX-License-Identifier: GPL-3.0-or-later
// Several needles in one tissue: needles at rest hold the tissue, bend and slip, and all laws hold for all needles.
#include "coupling/mirrored_block.hpp"
#include "coupling/needle_in_block.hpp"
#include "support/count_allocations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

constexpr double kTolerance = 1e-6;  // of the largest force

using Method = CouplingSettings::Method;

BlockOptions with(Method method) {
  BlockOptions options;
  options.coupling.method = method;
  return options;
}

std::unique_ptr<Needle> another_needle() { return BeamNeedle::build({150.0, 1.27, 15700, 12100}, 20, 42).value(); }

/// A block with several needles. Each is driven along its own axis.
struct Row {
  explicit Row(int needles, BlockOptions options = {})
      : block([&] {
          options.coupling.needles = needles;
          options.coupling.capacity = 40;
          return options;
        }()) {
    for (int k = 1; k < needles; ++k) EXPECT_TRUE(insertion().add_needle(another_needle()));
    places.resize(static_cast<std::size_t>(needles));
  }
  Insertion& insertion() { return *block.insertion; }

  /// Takes up a needle that is in the air.
  void aim(int needle, const Vec3& through, const Vec3& axis = Vec3::UnitZ()) {
    take_up(needle);
    block.sideways.setZero();
    block.aim(through, axis);
  }
  /// Takes up a needle and puts it in.
  void insert(int needle, const Vec3& through, double depth, const Vec3& axis = Vec3::UnitZ()) {
    aim(needle, through, axis);
    block.go(depth);
  }
  void take_up(int needle) {
    places[static_cast<std::size_t>(insertion().held())] = {block.point, block.axis, block.sideways, block.depth};
    const auto done = insertion().take_up(needle);
    ASSERT_TRUE(done) << done.error().message();
    const Place& place = places[static_cast<std::size_t>(needle)];
    block.point = place.point;
    block.axis = place.axis;
    block.sideways = place.sideways;
    block.depth = place.depth;
  }

  struct Place {
    Vec3 point = Vec3::Zero();
    Vec3 axis = Vec3::UnitZ();
    Vec3 sideways = Vec3::Zero();
    double depth = -1.0;
  };
  NeedleInBlock block;
  std::vector<Place> places;
};

/// Largest violation of the equations of all needles at once, over the largest force: each needle is in equilibrium
/// under its contacts, and no contact is beyond its friction.
struct Violation {
  double needle = 0.0;
  double gap = 0.0;
  double friction = 0.0;
  int sliding_at_rest = 0;
};

Violation violation(Row& row, const std::vector<RegionLaws>& laws) {
  Insertion& insertion = row.insertion();
  Violation worst;
  double peak = 1.0;
  for (int k = 0; k < insertion.needles(); ++k) {
    for (const ContactState& contact : insertion.contacts_of(k)) peak = std::max(peak, contact.force.norm());
  }
  for (int k = 0; k < insertion.needles(); ++k) {
    const auto contacts = insertion.contacts_of(k);
    const Needle& needle = insertion.needle(k);
    const auto twin = another_needle();
    twin->set_base(needle.base());
    twin->set_state(needle.state());
    std::vector<PointLoad> loads;
    for (const ContactState& contact : contacts)
      loads.push_back({std::clamp(contact.s, 0.0, needle.length()), -contact.force});
    worst.needle = std::max(worst.needle, twin->residual(loads) / needle.length() / peak);
    const FrictionLaw& law = laws.front().friction;
    for (const ContactState& contact : contacts) {
      if (contact.tip && k != insertion.held()) {  // it presses with at most its cutting force, and does not pull
        const double axial = contact.force.dot(needle.tangent(needle.length()));
        const double most = laws.front().cutting_N + 1.0;  // and more while it cuts fast, or before a membrane
        worst.friction = std::max({worst.friction, -axial / peak, (axial - most) / peak});
      }
      if (contact.tip || contact.s > needle.length() - 8.0) continue;  // young contacts yield
      const Vec3 t = needle.tangent(contact.s);
      const Vec3 gap = contact.position - needle.point(contact.s);
      const double own = 0.1;  // [mm/N], less than the tissue's compliance at a contact
      worst.gap = std::max(worst.gap, gap.norm() / own / peak);
      const double axial = std::abs(contact.force.dot(t));
      const double most =
          contact.sticking
              ? law.static_N_per_mm * contact.length
              : 1.01 * (law.coulomb_N_per_mm + law.viscous_Ns_per_mm2 * law.viscous_to_mm_per_s) * contact.length;
      worst.friction = std::max(worst.friction, (axial - most) / peak);
      if (k != insertion.held() && !contact.sticking) ++worst.sliding_at_rest;
    }
  }
  return worst;
}

TEST(SeveralNeedles, all_laws_hold_for_all_needles_in_random_procedures) {
  BlockOptions creeping;
  creeping.coupling.creep = {.factor = 2.0, .time_s = 0.5};
  BlockOptions stiffening;
  for (RegionLaws& laws : stiffening.laws) laws.stiffening_MPa = 0.5;
  int slid = 0;
  unsigned seed = 0;
  for (const BlockOptions& options : {with(Method::embedded), with(Method::near_field), creeping, stiffening}) {
    std::mt19937 random(++seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Row row(3, options);
    for (int k = 0; k < 3; ++k) {
      row.insert(k, Vec3(9.0 * (k - 1) + unit(random), 2.0 * unit(random), 0), 35.0 + 10.0 * unit(random),
                 Vec3(0.03 * unit(random), 0.03 * unit(random), 1));
    }
    for (int turn = 0; turn < 6; ++turn) {
      row.take_up(turn % 3);
      row.block.sideways += 0.5 * Vec3(unit(random), unit(random), 0);
      row.block.go(row.block.depth + 6.0 * unit(random));
      row.block.go(row.block.depth - 1.5);  // while the tip cuts, it hands its memory to the track after each balance
      const Violation now = violation(row, options.laws);
      EXPECT_LT(now.needle, kTolerance) << "seed " << seed << " turn " << turn;
      EXPECT_LT(now.gap, kTolerance) << "seed " << seed << " turn " << turn;
      EXPECT_LT(now.friction, kTolerance) << "seed " << seed << " turn " << turn;
      slid += now.sliding_at_rest;
    }
    EXPECT_EQ(row.block.flags & (Step::not_converged | Step::out_of_contacts), 0u) << "seed " << seed;
  }
  EXPECT_GT(slid, 0) << "no needle at rest has slipped, so that slipping was not tested";
}

/// The forces on the hands of four needles in each step of a random procedure.
std::vector<Vec3> forces_on_hands(BlockOptions options, int follow_from, unsigned seed) {
  options.coupling.follow_from = follow_from;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Row row(4, options);
  for (int k = 0; k < 4; ++k) {
    row.aim(k, Vec3(7.0 * (k % 2) + unit(random), 7.0 * (k / 2) + unit(random), 0),
            Vec3(0.03 * unit(random), 0.03 * unit(random), 1));
    if (k < 3) row.block.go(40.0 + 5.0 * unit(random));
  }
  std::vector<Vec3> forces;
  const auto go = [&](double way, int steps) {
    for (int k = 0; k < steps; ++k) {
      row.block.depth += way / steps;
      row.block.step(1e-3);
      for (int needle = 0; needle < 4; ++needle) forces.push_back(row.insertion().hand_force_on(needle));
    }
  };
  go(45.0, 1500);
  go(0.0, 100);
  go(-10.0, 300);
  EXPECT_EQ(row.block.flags & (Step::not_converged | Step::contact_cycling | Step::out_of_contacts), 0u);
  return forces;
}

TEST(SeveralNeedles, that_follow_have_the_forces_of_those_balanced_together) {
  BlockOptions elastic = with(Method::near_field);
  BlockOptions creeping;
  creeping.coupling.creep = {.factor = 4.0, .time_s = 0.6};
  for (RegionLaws& laws : creeping.laws) laws.stiffening_MPa = 0.5;
  for (const BlockOptions& options : {elastic, creeping}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const std::vector<Vec3> together = forces_on_hands(options, 10000, seed);
      const std::vector<Vec3> followed = forces_on_hands(options, 1, seed);
      ASSERT_EQ(together.size(), followed.size());
      double peak = 0.0;
      for (const Vec3& force : together) peak = std::max(peak, force.norm());
      std::vector<double> of_moved;
      std::vector<double> of_resting;
      for (std::size_t k = 0; k < together.size(); ++k)
        (k % 4 == 3 ? of_moved : of_resting).push_back((followed[k] - together[k]).norm() / peak);
      for (std::vector<double>* const off : {&of_moved, &of_resting}) std::sort(off->begin(), off->end());
      const auto quantile = [](const std::vector<double>& off, double part) {
        return off[static_cast<std::size_t>(part * static_cast<double>(off.size() - 1))];
      };
      // Where a surface breaks or a contact is made a step sooner, the forces of that step differ more. What creeping
      // tissue remembers is known less exactly.
      const double more = options.coupling.creep.is_any() ? 2.5 : 1.0;
      EXPECT_LT(quantile(of_moved, 0.5), 2e-5 * more) << "seed " << seed;
      EXPECT_LT(quantile(of_moved, 0.99), 2e-3) << "seed " << seed;
      EXPECT_LT(quantile(of_resting, 0.5), 5e-5 * more) << "seed " << seed;
      EXPECT_LT(quantile(of_resting, 0.99), 2e-3 * more) << "seed " << seed;
    }
  }
}

TEST(SeveralNeedles, the_tissue_is_displaced_as_by_one_solution_with_the_forces_of_all_needles) {
  Row row(2, with(Method::embedded));
  row.insert(0, Vec3(-6, 0, 0), 45.0);
  row.insert(1, Vec3(6, 1, 0), 30.0);
  const Insertion& insertion = row.insertion();
  const VecX u = row.block.tissue->solve(insertion.nodes().load);
  const double largest = u.lpNorm<Eigen::Infinity>();
  ASSERT_GT(largest, 0.1);
  EXPECT_LT((u - insertion.displacement()).lpNorm<Eigen::Infinity>(), 1e-9 * largest);
  for (int k = 0; k < 2; ++k) {
    const auto contacts = insertion.contacts_of(k);
    std::size_t shaft = 0;
    for (const ContactState& contact : contacts) {
      if (contact.tip) continue;
      const Track::Mark& mark = insertion.track(k).marks[shaft++];
      const Shape shape = row.block.tissue->shape(mark.at.tet, mark.at.weights);
      Vec3 at = mark.x;
      for (int i = 0; i < shape.count; ++i) {
        const auto n = static_cast<std::size_t>(i);
        at += shape.weight[n] * u.segment<3>(3 * Eigen::Index{shape.node[n]});
      }
      EXPECT_LT((at - contact.position).norm(), 1e-9 * largest);
    }
    EXPECT_GT(shaft, 3u);
  }
}

TEST(SeveralNeedles, laying_a_needle_down_and_taking_it_up_again_hardly_changes_its_forces) {
  Row row(2);
  row.insert(0, Vec3(-5, 0, 0), 40.0);
  row.block.wait(0.05);
  const Vec3 before = row.block.report.hand_force_N;
  ASSERT_GT(before.norm(), 0.3);
  row.aim(1, Vec3(40, 0, 0));
  row.block.wait(0.05);
  EXPECT_LT((row.insertion().hand_force_on(0) - before).norm(), 0.02 * before.norm());
  row.take_up(0);
  row.block.wait(0.05);
  EXPECT_LT((row.block.report.hand_force_N - before).norm(), 0.02 * before.norm());
}

/// How far a needle takes the tissue beside it along, alone or between two others that rest.
double dragged_along(bool with_others) {
  Row row(3);
  if (with_others) {
    row.insert(1, Vec3(-8, 0, 0), 60.0);
    row.insert(2, Vec3(8, 0, 0), 60.0);
  }
  const Vec3 x(0, 5, 40);
  row.aim(0, Vec3(0, 0, 0));
  row.block.step(1e-3);
  const Index node = static_cast<Index>(row.block.locator->find(x)->tet);
  const Index corner = row.block.tissue->mesh().tets[static_cast<std::size_t>(node)][0];
  const auto along = [&] { return row.insertion().displacement()[3 * Eigen::Index{corner} + 2]; };
  const double before = along();
  row.block.go(40.0);
  return along() - before;
}

TEST(SeveralNeedles, needles_at_rest_hold_the_tissue) {
  const double alone = dragged_along(false);
  const double held = dragged_along(true);
  EXPECT_GT(alone, 0.1);
  EXPECT_LT(held, 0.8 * alone);
}

TEST(SeveralNeedles, a_needle_at_rest_is_pulled_along_with_the_tissue_and_bears_it_at_its_lock) {
  Row row(2);
  row.insert(0, Vec3(-6, 0, 0), 60.0);
  row.aim(1, Vec3(6, 0, 0));
  const double before = row.insertion().hand_force_on(0).z();
  row.block.go(45.0);
  EXPECT_LT(row.insertion().hand_force_on(0).z(), before - 0.05) << "the tissue takes the needle at rest along";
  double support = 0.0;
  const auto nodes = row.insertion().nodes();
  for (Eigen::Index k = 2; k < nodes.support.size(); k += 3) support += nodes.support[k];
  EXPECT_NEAR(row.insertion().hand_force_on(0).z() + row.insertion().hand_force_on(1).z(), -support, 1e-6);
}

TEST(SeveralNeedles, the_tissue_is_at_rest_once_all_are_out) {
  Row row(3);
  for (int k = 0; k < 3; ++k) row.insert(k, Vec3(8.0 * (k - 1), 0, 0), 30.0 + 5.0 * k);
  for (const int k : {1, 0, 2}) {
    row.take_up(k);
    row.block.go(-2.0);
    EXPECT_FALSE(row.insertion().in_tissue(k));
    EXPECT_EQ(row.insertion().displacement().norm() > 0.0, k != 2);
  }
  EXPECT_EQ(row.block.count(EventKind::withdrawn), 3);
}

/// The depth, force and displacement of a procedure in a block that is its own mirror image, or of its mirror image.
std::vector<double> mirrored_procedure(double side) {
  BlockOptions options = with(Method::embedded);
  options.lo = {0, -50, 0};
  options.cells = {4, 8, 8};
  options.edit = [](TetMesh& mesh) {
    for (Vec3& x : mesh.nodes) {
      if (x.x() < 1e-9) x.x() = 0.0;
    }
    test::mirror(mesh);
  };
  Row row(2, options);
  row.insert(0, Vec3(-7 * side, 3, 0), 42.0, Vec3(0.02 * side, 0.01, 1));
  row.insert(1, Vec3(5 * side, -2, 0), 33.0);
  row.take_up(0);
  row.block.go(30.0);
  const Vec3 first = row.insertion().hand_force_on(0);
  const Vec3 second = row.insertion().hand_force_on(1);
  return {side * first.x(), first.y(), first.z(), side * second.x(), second.y(), second.z()};
}

TEST(SeveralNeedles, a_mirrored_procedure_has_mirrored_forces) {
  const auto left = mirrored_procedure(1.0);
  const auto right = mirrored_procedure(-1.0);
  for (std::size_t k = 0; k < left.size(); ++k) EXPECT_NEAR(left[k], right[k], 1e-8);
}

TEST(SeveralNeedles, a_step_does_not_allocate_with_needles_at_rest) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "allocations cannot be counted in this build";
  for (const int follow_from : {1, 10000}) {
    BlockOptions options;
    options.coupling.follow_from = follow_from;
    options.coupling.creep = {.factor = 2.0, .time_s = 0.5};
    Row row(2, options);
    row.insert(0, Vec3(-6, 0, 0), 45.0);
    row.aim(1, Vec3(6, 0, 0));
    for (int k = 0; k < 600; ++k) {
      row.insertion().prepare(8.0);
      row.block.depth += 0.05;
      const test::AllocationCount allocations;
      row.insertion().step(row.block.pose(), 2.5e-3);
      ASSERT_EQ(allocations.count(), 0) << "at depth " << row.block.depth << ", follow_from " << follow_from;
    }
  }
}

TEST(SeveralNeedles, what_is_not_possible_is_refused_in_words) {
  Row row(2);
  const auto third = row.insertion().add_needle(another_needle());
  ASSERT_FALSE(third);
  EXPECT_NE(third.error().message().find("CouplingSettings::needles"), std::string::npos);
  const auto unknown = row.insertion().take_up(2);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message().find("there is no needle 2"), std::string::npos);
  EXPECT_EQ(row.insertion().held(), 0);
  BlockOptions staggered;
  staggered.coupling.solver = CouplingSettings::Solver::staggered;
  staggered.coupling.needles = 2;
  NeedleInBlock block(staggered);
  EXPECT_FALSE(block.insertion->add_needle(another_needle()));
}

}  // namespace
}  // namespace stylet
