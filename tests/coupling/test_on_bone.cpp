// SPDX-License-Identifier: GPL-3.0-or-later
// A needle whose tip stands on bone: it is stopped, bows out, and snaps.
#include "needle_in_block.hpp"
#include "stylet/needle/guided.hpp"
#include "stylet/needle/make_needle.hpp"

using namespace stylet;
using namespace stylet::test;
using Kind = EventKind;

namespace {

/// A slab of bone across the needle's path at z = 40 … 60 mm.
BlockOptions with_bone() {
  BlockOptions options;
  options.cells = {10, 10, 10};
  options.jitter = 0.0;
  options.regions = {"body", "bone"};
  options.region_at = [](const Vec3& x) { return x.z() > 40 && x.z() < 60 && x.x() > -15 ? 1 : 0; };
  options.materials = {{0.06, 0.45}, {10.0, 0.3}};
  options.laws[1] = {10.0, 0.0, {}, true, false, -1};
  return options;
}

}  // namespace

TEST(OnBone, bone_cannot_be_cut_and_the_force_rises) {
  NeedleInBlock run(with_bone());
  run.aim({3, 2, 0});
  run.go(39.5);
  const double before = run.forces.back();
  run.go(42, 5.0);
  ASSERT_EQ(run.count(Kind::bone_contact, 1), 1);
  EXPECT_NEAR(run.first(Kind::bone_contact)->depth, 40.0, 1.5);
  EXPECT_EQ(run.report.tip_state, TipState::bone);
  EXPECT_LT(run.insertion->track().end.z(), 40.0 + 1e-9);
  EXPECT_GT(run.forces.back(), before + 2.0);
  EXPECT_EQ(run.count(Kind::puncture, 1), 0);
  run.go(-1);
  EXPECT_EQ(run.count(Kind::withdrawn), 1);
}

namespace {

/// Presses an oblique needle 20 mm further onto bone, where it bows out between hand and skin.
struct PressedOnBone : NeedleInBlock {
  explicit PressedOnBone(double needle_length_mm, double damping_s = CouplingSettings{}.bone_damping_s,
                         double spacing_mm = 4.0)
      : PressedOnBone(options(needle_length_mm, damping_s, spacing_mm)) {}
  /// @param ways [mm] motions of the base in the steps on bone, in turn; at 20 mm/s
  explicit PressedOnBone(const BlockOptions& options, const std::vector<double>& ways = {0.02})
      : NeedleInBlock(options) {
    const Vec3 entry(3, 2, 0);
    const Vec3 along = Vec3(0.05, 0.02, 1.0).normalized();
    insertion->place_guide(entry - 10.0 * along, along);  // of a needle with a guide
    aim(entry, along);
    go(39.0);
    while (depth < 60.0 - 1e-9) {
      const double way = ways[static_cast<std::size_t>(steps) % ways.size()];
      go(depth + way, 20.0, way / 20.0);
      iterations += report.iterations;
      most = std::max(most, report.iterations);
      double largest = 0.0;
      for (const ContactState& contact : insertion->contacts()) largest = std::max(largest, contact.force.norm());
      if (report.flags & Step::not_converged) {
        ++unbalanced;
        grown = std::max(grown, largest / borne);
      }
      borne = std::max(borne, largest);
      ++steps;
    }
  }
  static BlockOptions options(double needle_length_mm, double damping_s = CouplingSettings{}.bone_damping_s,
                              double spacing_mm = 4.0) {
    BlockOptions result = with_bone();
    result.needle_length = needle_length_mm;
    result.coupling.bone_damping_s = damping_s;
    result.coupling.spacing_mm = spacing_mm;
    return result;
  }
  /// [mm] Distance of the tip from the needle's line.
  [[nodiscard]] double bow() const { return axis.cross(report.tip_mm - point).norm(); }
  int iterations = 0;
  int most = 0;        ///< largest number in a step
  int unbalanced = 0;  ///< number of steps without balance
  double borne = 1.0;  ///< [N] largest force of a contact in all steps so far, at least 1 N
  double grown = 0.0;  ///< largest force in a step without balance, over those that were borne before
  int steps = 0;
};

}  // namespace

TEST(OnBone, a_needle_bows_between_hand_and_bone_in_a_few_iterations_a_step) {
  // The tip is held along the needle only: its direction, and so its force, turns as the needle bows.
  const PressedOnBone run(220.0);
  EXPECT_EQ(run.report.tip_state, TipState::bone);
  EXPECT_GT(run.peak(), 10.0);
  EXPECT_EQ(run.flags, 0u);
  EXPECT_LT(run.iterations, 6 * run.steps);
  EXPECT_LT(run.most, 15);
}

TEST(OnBone, a_needle_that_snaps_off_bone_is_balanced_in_every_step) {
  // A short needle bears more than its tip does. Damping turns the snap into a motion.
  for (const double spacing : {1.4, 4.0}) {
    const PressedOnBone run(150.0, CouplingSettings{}.bone_damping_s, spacing);
    EXPECT_EQ(run.unbalanced, 0);
    EXPECT_LT(run.iterations, 3 * run.steps);
    EXPECT_LT(run.most, 100) << "where it strikes the bone, the step is taken in parts";
  }
}

TEST(OnBone, needles_of_every_model_snap_off_bone_into_the_same_shape) {
  PressedOnBone beam(150.0);
  beam.wait(0.2);
  EXPECT_GT(beam.peak(), 1.2 * beam.forces.back()) << "it has not snapped";
  for (const std::string& model : needle_models()) {
    SCOPED_TRACE(model);
    if (kSanitized && model == "tet") continue;  // takes minutes; tests/needle check its memory use
    BlockOptions options = PressedOnBone::options(150.0);
    options.needle = [&](int capacity) {
      const NeedleSection section{150.0, 1.27, 15700, 12100};
      return make_needle(model, section, default_needle_elements(model).value(), capacity).value();
    };
    PressedOnBone run(options);
    EXPECT_EQ(run.unbalanced, 0);
    EXPECT_LT(run.peak(), 1.5 * beam.peak());
    run.wait(0.2);
    EXPECT_NEAR(run.forces.back(), beam.forces.back(), 0.01 * beam.forces.back());
    EXPECT_NEAR(run.bow(), beam.bow(), 0.01 * beam.bow());
  }
}

TEST(OnBone, steps_of_changing_length_bend_a_needle_alike) {
  PressedOnBone even(220.0);
  for (const std::vector<double>& ways : {std::vector<double>{0.01, 0.04}, {0.02, 0.1}}) {
    PressedOnBone uneven(PressedOnBone::options(220.0), ways);
    EXPECT_EQ(uneven.unbalanced, 0);
    // Compared during the motion, where damping changes the force by tens of millinewtons, at depths that both runs
    // reach.
    int compared = 0;
    for (std::size_t k = 0, j = 0; k < uneven.depths.size(); ++k) {
      while (j + 1 < even.depths.size() && even.depths[j] < uneven.depths[k] - 1e-6) ++j;
      if (uneven.depths[k] < 41.0 || std::abs(even.depths[j] - uneven.depths[k]) > 1e-6) continue;
      ASSERT_NEAR(uneven.forces[k], even.forces[j], 1e-3 * even.peak()) << uneven.depths[k] << " mm";
      ++compared;
    }
    EXPECT_GT(compared, 100);
  }
}

TEST(OnBone, a_guide_in_front_of_the_skin_makes_a_needle_bear_more_on_bone) {
  for (const double length : {150.0, 220.0}) {
    BlockOptions options = PressedOnBone::options(length);
    options.needle = [length](int capacity) -> std::unique_ptr<Needle> {
      auto beam = BeamNeedle::build({length, 1.27, 15700, 12100}, 20, capacity + 1).value();
      return std::make_unique<GuidedNeedle>(std::move(beam), GuideHole{}, capacity);
    };
    PressedOnBone guided(options);
    PressedOnBone alone(length);
    EXPECT_EQ(guided.unbalanced, 0);
    EXPECT_GT(guided.report.guide_force_N.norm(), 0.1);
    EXPECT_GT(guided.forces.back(), 1.2 * alone.forces.back());
  }
}

TEST(OnBone, damping_on_bone_leaves_a_needle_at_rest_where_it_would_be_without) {
  PressedOnBone damped(220.0);
  PressedOnBone undamped(220.0, 0.0);
  double most_apart = 0.0;
  for (std::size_t k = 0; k < damped.forces.size(); ++k)
    most_apart = std::max(most_apart, std::abs(damped.forces[k] - undamped.forces[k]));
  EXPECT_LT(most_apart, 0.1 * undamped.peak());
  EXPECT_GT(most_apart, 1e-3 * undamped.peak()) << "damping does nothing";
  damped.wait(0.2);
  undamped.wait(0.2);
  EXPECT_NEAR(damped.forces.back(), undamped.forces.back(), 1e-4 * undamped.forces.back());
  // The direction of the bow is decided by very small forces and creeps; its size is not.
  EXPECT_NEAR(damped.bow(), undamped.bow(), 0.01 * undamped.bow());
}

TEST(OnBone, a_balance_that_is_not_found_is_broken_off_and_leaves_no_force_beyond_those_that_were) {
  // Without damping there is no balance on the way to the next shape, however short the parts of a step are.
  const PressedOnBone run(150.0, 0.0);
  EXPECT_TRUE(run.flags & Step::not_converged) << "the situation this is about has not come about";
  EXPECT_LT(run.most, 85 * 30) << "it was not broken off";
  EXPECT_LE(run.grown, 2.0);
}

TEST(OnBone, bone_under_the_skin_is_touched_without_a_puncture) {
  BlockOptions options = with_bone();
  options.region_at = [](const Vec3& x) { return x.z() < 20 ? 1 : 0; };
  NeedleInBlock run(options);
  run.aim({3, 2, 0});
  run.go(1.0, 5.0);
  EXPECT_EQ(run.count(Kind::skin_contact), 1);
  EXPECT_EQ(run.count(Kind::bone_contact), 1);
  EXPECT_EQ(run.count(Kind::puncture), 0);
  EXPECT_GT(run.forces.back(), 1.0);
  run.go(-1, 5.0);
  EXPECT_EQ(run.count(Kind::withdrawn), 1);
}
