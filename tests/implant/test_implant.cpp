// SPDX-License-Identifier: GPL-3.0-or-later
// Whole implants in a cubic patient.
#include "sim/box_patient.hpp"
#include "stylet/implant/implant.hpp"
#include "stylet/sim/simulation.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

namespace stylet {
namespace {

constexpr double kSeed_mm = 4.5;

/// Two needles with three seeds each, one of them beside the middle.
DosePlan two_needles() {
  DosePlan plan;
  plan.file = "plan.csv";
  for (const auto& [name, x, y] : {std::tuple{"left", 6.0, 4.0}, std::tuple{"right", -4.0, 9.0}}) {
    for (const double z : {38.0, 30.0, 22.0})
      plan.sources.push_back(
          {.at_mm = Vec3(x, y, z), .axis = Vec3::UnitZ(), .has_axis = true, .strength_U = 0.5, .needle = name});
  }
  return plan;
}

Scenario scenario() {
  Scenario s = test::box_scenario();
  s.insertions.clear();
  s.procedure.speed_mm_per_s = 40.0;
  s.procedure.retract_speed_mm_per_s = 40.0;
  s.procedure.drop_speed_mm_per_s = 20.0;
  s.procedure.pause_s = 0.3;
  return s;
}

ImplantHistory simulated(const Scenario& s, const TetMesh& mesh, const DosePlan& plan) {
  auto history = simulate_implant(s, mesh, load_needles(plan, kSeed_mm, 0.0).value(), kSeed_mm, "case.toml");
  if (!history) throw std::runtime_error(history.error().message());
  return *history;
}

TEST(Implant, leaves_all_seeds_in_the_tissue_and_the_causes_add_up_to_the_error) {
  for (const SeedTechnique technique : {SeedTechnique::preloaded, SeedTechnique::pushed}) {
    Scenario s = scenario();
    s.procedure.technique = technique;
    s.seed.release_sd_mm = 0.5;
    const ImplantHistory history = simulated(s, test::box_patient(), two_needles());
    ASSERT_EQ(history.seeds.size(), 6U);
    ASSERT_EQ(history.needles.size(), 2U);
    double moved = 0.0;
    for (std::size_t k = 0; k < history.seeds.size(); ++k) {
      const SeedHistory& seed = history.seeds[k];
      EXPECT_EQ(seed.number, k);
      EXPECT_TRUE(seed.in_tissue);
      Vec3 sum = Vec3::Zero();
      for (const Vec3& cause : seed.cause_mm) sum += cause;
      EXPECT_LT((sum - seed.error_mm()).norm(), 1e-9);
      EXPECT_LT(seed.error_mm().norm(), 10.0);
      EXPECT_GT(seed.axis.z(), 0.8);
      EXPECT_NEAR(seed.axis.norm(), 1.0, 1e-12);
      moved = std::max(moved, (seed.by(SeedCause::motion) + seed.by(SeedCause::relaxation)).norm());
    }
    EXPECT_GT(moved, 0.1) << "the tissue moves";
    for (const NeedleHistory& needle : history.needles) EXPECT_GT(needle.peak_force_N, 0.5);
  }
}

// Friction drags the tissue inferior while the cannula is drawn back. A seed that is left in it lies superior of its
// plan once the tissue has gone back.
TEST(Implant, in_elastic_tissue_puts_the_last_seeds_superior_of_their_plan) {
  Scenario s = scenario();
  s.tissue_model.creep = 1.0;
  const ImplantHistory history = simulated(s, test::box_patient(), two_needles());
  for (const SeedHistory& seed : history.seeds) {
    EXPECT_EQ(seed.by(SeedCause::relaxation), Vec3::Zero());
    if (seed.number % 3 == 2) {
      EXPECT_GT(seed.by(SeedCause::motion).z(), 0.0) << seed.number;
    }
  }
}

TEST(Implant, in_tissue_without_friction_and_cutting_force_drops_seeds_nearly_where_planned) {
  Scenario s = scenario();
  s.tissue_model.preset = TissuePreset::linear;
  for (const char* region : {"body", "prostate"}) {
    TissueParameters tissue = default_tissue(region, TissuePreset::linear);
    tissue.puncture_N = 0.0;
    tissue.cutting_N = 1e-4;
    tissue.friction_static_N_per_m = tissue.friction_coulomb_N_per_m = tissue.friction_viscous_Ns_per_m2 = 0.0;
    s.tissue[region] = tissue;
  }
  s.coupling.tip_viscosity_Ns_per_m = 0.01;
  const ImplantHistory history = simulated(s, test::box_patient(), two_needles());
  for (const SeedHistory& seed : history.seeds) EXPECT_LT(seed.error_mm().norm(), 0.02);
}

TetMesh mirrored(TetMesh mesh) {
  for (Vec3& x : mesh.nodes) x.x() = -x.x();
  for (auto& tet : mesh.tets) std::swap(tet[0], tet[1]);
  return mesh;
}

/// Largest difference [mm] between the seeds in a patient and those in its mirror image.
double off_mirror(const Scenario& s) {
  DosePlan plan = two_needles();
  const ImplantHistory here = simulated(s, test::box_patient(), plan);
  for (PlannedSource& source : plan.sources) source.at_mm.x() = -source.at_mm.x();
  const ImplantHistory there = simulated(s, mirrored(test::box_patient()), plan);
  double largest = 0.0;
  for (std::size_t k = 0; k < here.seeds.size(); ++k) {
    const Vec3& b = there.seeds[k].rest_mm;
    largest = std::max(largest, (here.seeds[k].rest_mm - Vec3(-b.x(), b.y(), b.z())).norm());
  }
  return largest;
}

TEST(Implant, in_a_mirrored_patient_is_mirrored) {
  Scenario s = scenario();
  s.coupling.method = CouplingSettings::Method::embedded;
  EXPECT_LT(off_mirror(s), 1e-8);
}

// The near field changes by some micrometres from element to element, and rounding decides to which element a point at
// a border belongs.
TEST(Implant, in_a_mirrored_patient_is_mirrored_but_for_elements_chosen_by_rounding) {
  EXPECT_LT(off_mirror(scenario()), 0.05);
}

TEST(Implant, of_needles_that_say_so_themselves_has_strands_beside_loose_seeds) {
  auto loads = load_needles(two_needles(), kSeed_mm, 0.0).value();
  loads[1].stranded = true;
  const auto history = simulate_implant(scenario(), test::box_patient(), loads, kSeed_mm, "case.toml");
  ASSERT_TRUE(history);
  double stranded = 0.0;
  for (const SeedHistory& seed : history->seeds) {
    if (seed.needle == 0) {
      EXPECT_EQ(seed.by(SeedCause::strand), Vec3::Zero());
    } else {
      stranded = std::max(stranded, seed.by(SeedCause::strand).norm());
    }
  }
  EXPECT_GT(stranded, 1e-3) << "loose seeds do not keep their distances";
}

TEST(Implant, of_needles_together_drops_all_seeds_and_needles_one_by_one_are_as_before) {
  Scenario s = scenario();
  const ImplantHistory one = simulated(s, test::box_patient(), two_needles());
  s.procedure.together = NeedlesTogether::all;
  const ImplantHistory together = simulated(s, test::box_patient(), two_needles());
  ASSERT_EQ(together.seeds.size(), one.seeds.size());
  ASSERT_EQ(together.needles.size(), 2U);
  double largest = 0.0;
  for (std::size_t k = 0; k < one.seeds.size(); ++k) {
    EXPECT_TRUE(together.seeds[k].in_tissue);
    EXPECT_EQ(together.seeds[k].needle, one.seeds[k].needle);
    largest = std::max(largest, (together.seeds[k].rest_mm - one.seeds[k].rest_mm).norm());
  }
  EXPECT_GT(largest, 0.01) << "needles in one tissue feel each other";
  EXPECT_LT(largest, 5.0);
  // Needles of a row are those whose tips are at the same height: here each needle is a row by itself.
  s.procedure.together = NeedlesTogether::row;
  const ImplantHistory rows = simulated(s, test::box_patient(), two_needles());
  for (std::size_t k = 0; k < one.seeds.size(); ++k)
    EXPECT_LT((rows.seeds[k].rest_mm - one.seeds[k].rest_mm).norm(), 1e-6);
}

TEST(Implant, feels_its_stabilising_needles_which_are_none_of_the_plan) {
  Scenario s = scenario();
  const ImplantHistory without = simulated(s, test::box_patient(), two_needles());
  s.procedure.stabilising = {"B4", "F4"};
  const ImplantHistory with = simulated(s, test::box_patient(), two_needles());
  ASSERT_EQ(with.seeds.size(), without.seeds.size());
  EXPECT_EQ(with.needles.size(), 2U);
  double largest = 0.0;
  for (std::size_t k = 0; k < with.seeds.size(); ++k) {
    EXPECT_TRUE(with.seeds[k].in_tissue);
    largest = std::max(largest, (with.seeds[k].rest_mm - without.seeds[k].rest_mm).norm());
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(largest, 5.0);
}

// Were the wide part of the compliance, which creeps, not positive for the points of all needles together, the creep
// would feed itself, and the forces between needles at rest would grow exponentially.
TEST(Implant, in_creeping_tissue_has_a_positive_compliance_among_the_points_of_all_needles) {
  Scenario s = scenario();
  for (const double x : {0.0, 5.0, 10.0}) {
    InsertionPlan& plan = s.insertions.emplace_back();
    plan.entry_mm = {x, 5.0, 0.0};
    plan.direction = {0.0, 0.0, 1.0};
    plan.depth_mm = 45.0;
  }
  const auto model = Model::compile(s, test::box_patient(), "case.toml").value();
  Simulation simulation(model, 3);
  for (int needle = 0; needle < 3; ++needle) {
    ASSERT_TRUE(simulation.take_up(needle));
    const PlannedInsertion& plan = model->insertions()[static_cast<std::size_t>(needle)];
    Pose base = plan.motion.at(0.0);
    simulation.place(base, plan.entry, plan.direction);
    while (simulation.last_step().base_depth_mm < plan.depth_mm) {
      base.origin += 0.16 * plan.direction;
      simulation.prepare();
      simulation.step(base, 4e-3);
    }
  }
  const ContactCompliance& compliance = simulation.insertion().compliance();
  const Eigen::Index of_shafts = 3 * (static_cast<Eigen::Index>(compliance.points()) - 1);
  ASSERT_GT(of_shafts, 60);
  const MatX wide = compliance.wide().block(3, 3, of_shafts, of_shafts);
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(wide, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-3 * eigen.eigenvalues().maxCoeff());
  const double creeps = simulation.insertion().settings().creep.factor - 1.0;
  ASSERT_GT(creeps, 0.0);
  const MatX after_creep = compliance.matrix().block(3, 3, of_shafts, of_shafts) + creeps * wide;
  EXPECT_EQ(Eigen::LLT<MatX>(after_creep).info(), Eigen::Success) << "the tissue does not come to rest";
}

TEST(Implant, keeps_the_steps_of_each_needle_and_its_shape_where_it_leaves_seeds) {
  const ImplantHistory history = simulated(scenario(), test::box_patient(), two_needles());
  EXPECT_TRUE(history.stabilising.empty());
  for (std::size_t n = 0; n < history.needles.size(); ++n) {
    const NeedleHistory& needle = history.needles[n];
    const NeedleRecord& record = needle.record;
    EXPECT_EQ(record.group, n);
    ASSERT_EQ(record.steps.size(), static_cast<std::size_t>(needle.steps));
    double peak = 0.0, deepest = 0.0, seconds = 0.0;
    for (std::size_t k = 0; k < record.steps.size(); ++k) {
      peak = std::max(peak, std::abs(record.steps[k].force_axial_N));
      deepest = std::max(deepest, record.steps[k].base_depth_mm);
      seconds += 1e-6 * record.steps[k].step_us;
      EXPECT_GT(record.steps[k].time_s, k > 0 ? record.steps[k - 1].time_s : 0.0);
    }
    EXPECT_EQ(peak, needle.peak_force_N);
    EXPECT_NEAR(deepest, needle.depth_mm, 1e-6);
    EXPECT_NEAR(seconds, needle.seconds, 1e-9);
    ASSERT_EQ(record.shapes.size(), 4U);
    EXPECT_EQ(record.shapes.front().when, "full depth");
    EXPECT_NEAR(record.shapes.front().base_depth_mm, needle.depth_mm, 0.5);
    for (std::size_t k = 0; k < 3; ++k) {
      const SeedHistory& seed = history.seeds[3 * n + k];
      const NeedleShape& shape = record.shapes[k + 1];
      EXPECT_EQ(shape.when, "seed " + std::to_string(seed.number + 1) + " dropped");
      EXPECT_NEAR(shape.time_s, seed.dropped_s, 1e-6) << "one needle at a time";
      ASSERT_EQ(shape.points_mm.size(), static_cast<std::size_t>(kNeedleShapePoints));
      // The cannula's tip has just passed the seed that it leaves.
      EXPECT_LT((shape.points_mm.back() - seed.dropped_mm).norm(), 5.0);
    }
  }
}

TEST(Implant, keeps_the_shapes_of_needles_that_are_in_place_together) {
  Scenario s = scenario();
  s.procedure.together = NeedlesTogether::all;
  s.procedure.stabilising = {"B4"};
  const ImplantHistory history = simulated(s, test::box_patient(), two_needles());
  ASSERT_EQ(history.stabilising.size(), 1U);
  EXPECT_EQ(history.stabilising[0].name, "stabilising B4");
  std::vector<NeedleHistory> all = history.needles;
  all.push_back(history.stabilising[0]);
  double time_s = 0.0;
  for (const NeedleHistory& needle : all) {
    ASSERT_GE(needle.record.shapes.size(), 2U);
    const NeedleShape &deep = needle.record.shapes[0], &together = needle.record.shapes[1];
    EXPECT_EQ(together.when, kAllInPlace);
    EXPECT_GE(together.time_s, deep.time_s);
    time_s = std::max(time_s, together.time_s);
    // The hub is locked; the tip may have been moved by the needles that went in later.
    EXPECT_LT((together.points_mm.front() - deep.points_mm.front()).norm(), 1e-6);
    EXPECT_LT((together.points_mm.back() - deep.points_mm.back()).norm(), 3.0);
  }
  for (const NeedleHistory& needle : all) EXPECT_EQ(needle.record.shapes[1].time_s, time_s) << "at one moment";
}

TEST(Implant, refuses_a_plan_beside_the_patient_and_a_needle_that_is_too_short) {
  DosePlan plan = two_needles();
  for (PlannedSource& source : plan.sources) source.at_mm.x() += 200.0;
  const auto beside = simulate_implant(scenario(), test::box_patient(), load_needles(plan, kSeed_mm, 0.0).value(),
                                       kSeed_mm, "case.toml");
  ASSERT_FALSE(beside.ok());
  EXPECT_SAYS(beside.error().message(), "case.toml, needle left: its line");
  Scenario s = scenario();
  s.needle.length_mm = 40.0;
  const auto short_needle = simulate_implant(s, test::box_patient(), load_needles(two_needles(), kSeed_mm, 0.0).value(),
                                             kSeed_mm, "case.toml");
  ASSERT_FALSE(short_needle.ok());
  EXPECT_SAYS(short_needle.error().message(), "needle.length_mm");
}

}  // namespace
}  // namespace stylet
