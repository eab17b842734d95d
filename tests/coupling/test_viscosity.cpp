// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/tissue_memory.hpp"

#include "needle_in_block.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "support/count_allocations.hpp"

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

// A single tissue point of compliance A, which is enough to compare the memory with closed forms.
class TwoPoints final : public ContactCompliance {
 public:
  TwoPoints() {
    points_ = 2;
    A_ = MatX::Identity(6, 6) * 2.0;
    A_.block<3, 3>(0, 3) = A_.block<3, 3>(3, 0) = 0.5 * Mat3::Identity();
  }
  Added add(const MaterialPoint&, const Vec3&, Placement, const Vec3&) override { return {}; }
  bool move_tip(const MaterialPoint&, const Vec3&) override { return true; }
  [[nodiscard]] bool available(Index) const override { return true; }
  void remove_last_embedded() override {}
  void reset() override {}
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>&) const override { return Mat3::Zero(); }
  [[nodiscard]] VecX displacement(const Eigen::Ref<const MatX>&) const override { return {}; }
  [[nodiscard]] Nodes nodes(const Eigen::Ref<const MatX>&) const override { return {}; }
  [[nodiscard]] std::span<const RemeshEvent> remeshing() const override { return {}; }
};

constexpr double kTau_s = 0.2;
constexpr Creep kCreep{3.0, kTau_s};

// Lets the forces act for `time` in steps of h.
void act(TissueMemory& memory, const MatX& forces, double time, double h) {
  for (int k = 0; k < std::lround(time / h); ++k) {
    memory.begin(h);
    memory.end(forces);
  }
}

// Creep displacement of point 0 after `time` under a constant force of 1 N along x on point 1, in steps of h.
double creep(double time, double h) {
  const TwoPoints compliance;
  TissueMemory memory(kCreep, 2);
  MatX forces = MatX::Zero(3, 2);
  forces(0, 1) = 1.0;
  act(memory, forces, time, h);
  return memory.displacement(compliance, 0).x();
}

TEST(TissueMemory, creeps_under_a_constant_force_as_a_standard_linear_solid_does_to_first_order_in_time) {
  for (const double time : {0.1, 0.2, 0.6}) {
    const double exact = 0.5 * (kCreep.factor - 1.0) * (1.0 - std::exp(-time / kTau_s));
    const double coarse = creep(time, 2e-3) - exact;
    const double fine = creep(time, 1e-3) - exact;
    EXPECT_LT(std::abs(fine), 2e-3 * exact);
    EXPECT_NEAR(coarse / fine, 2.0, 0.02) << time;
  }
}

TEST(TissueMemory, relaxes_under_a_constant_displacement_with_the_time_constant_over_the_factor) {
  // u = A (f + p), with p by the law, solved for f: G(t) = [1 + (r − 1) exp(−r t/τ)] / (r A).
  const TwoPoints compliance;
  const double own = compliance.matrix()(0, 0);
  const double r = kCreep.factor;
  const auto force_after = [&](double time, double h) {
    TissueMemory memory(kCreep, 2);
    MatX forces = MatX::Zero(3, 2);
    for (int k = 0; k < std::lround(time / h); ++k) {
      memory.begin(h);
      forces(0, 0) = (1.0 - memory.displacement(compliance, 0).x()) / (own * (1.0 + memory.share()));
      memory.end(forces);
    }
    return forces(0, 0);
  };
  EXPECT_NEAR(force_after(1e-6, 1e-6), 1.0 / own, 1e-4 / own) << "at once it is as stiff as elastic tissue";
  for (const double time : {0.02, 0.1, 0.4}) {
    const double exact = (1.0 + (r - 1.0) * std::exp(-r * time / kTau_s)) / (r * own);
    const double coarse = force_after(time, 1e-3) - exact;
    const double fine = force_after(time, 0.5e-3) - exact;
    EXPECT_LT(std::abs(fine), 3e-3 * exact) << time;
    EXPECT_NEAR(coarse / fine, 2.0, 0.05) << time;
  }
  EXPECT_NEAR(force_after(20.0 * kTau_s, 1e-3), 1.0 / (r * own), 1e-6 / own) << "in the end r times softer";
}

TEST(TissueMemory, goes_back_when_the_force_is_gone_and_then_is_relaxed) {
  const TwoPoints compliance;
  TissueMemory memory(kCreep, 2);
  MatX forces = MatX::Zero(3, 2);
  forces(2, 1) = 1.0;
  memory.begin(10.0);
  memory.end(forces);
  const double before = memory.displacement(compliance, 1).z();
  forces.setZero();
  act(memory, forces, kTau_s, 1e-3);
  EXPECT_NEAR(memory.displacement(compliance, 1).z() / before, std::exp(-1.0), 2e-3);
  EXPECT_FALSE(memory.relaxed(compliance));
  act(memory, forces, 20.0 * kTau_s, 1e-3);
  EXPECT_TRUE(memory.relaxed(compliance));
}

TEST(TissueMemory, hands_over_force_without_losing_any) {
  TissueMemory memory(kCreep, 2);
  MatX forces = MatX::Zero(3, 2);
  forces(1, 0) = 4.0;
  memory.begin(1.0);
  memory.end(forces);
  const double all = memory.past(0)[1];
  memory.hand_over(0, 1, 0.25);
  EXPECT_DOUBLE_EQ(memory.past(0)[1], 0.75 * all);
  EXPECT_DOUBLE_EQ(memory.past(1)[1], 0.25 * all);
}

TEST(TissueMemory, remembers_nothing_without_creep) {
  const TwoPoints compliance;
  TissueMemory memory({1.0, kTau_s}, 2);
  memory.begin(1e-3);
  EXPECT_EQ(memory.share(), 0.0);
  memory.end(MatX::Ones(3, 2));
  EXPECT_EQ(memory.displacement(compliance, 0), Vec3::Zero());
  EXPECT_TRUE(memory.relaxed(compliance));
}

constexpr double kQuick_s = 0.05;

BlockOptions creeping(const Creep& creep, CouplingSettings::Method method = CouplingSettings::Method::embedded) {
  BlockOptions options;
  options.cells = {6, 6, 6};
  options.coupling.method = method;
  options.coupling.creep = creep;
  return options;
}

// The needle pushed in to 30 mm, where it sticks, and then held.
NeedleInBlock pushed_in(const Creep& creep, double dt,
                        CouplingSettings::Method method = CouplingSettings::Method::embedded) {
  NeedleInBlock run(creeping(creep, method));
  run.aim({2.0, 3.0, 0.0});
  run.go(30.0, 20.0, dt);
  return run;
}

/// A block of one tissue of Young's modulus 0.06 MPa over `softer`, with the needle pressed `deep` into its skin.
NeedleInBlock pressed(const Creep& creep, double softer, double deep, double speed, double dt) {
  BlockOptions options = creeping(creep);
  options.region_at = [](const Vec3&) { return 0; };
  options.materials[0].young_MPa /= softer;
  options.laws[0].puncture_N = 50.0;
  NeedleInBlock run(options);
  run.aim({2.0, 3.0, 0.0}, Vec3::UnitZ(), 0.0);
  run.go(deep, speed, dt);
  return run;
}

TEST(ViscousTissue, is_elastic_of_its_own_modulus_for_a_fast_needle_and_of_one_r_times_smaller_for_a_slow_one) {
  constexpr double deep = 4.0;
  const double elastic = pressed({}, 1.0, deep, 20.0, 1e-3).last_force.z();
  const double softer = pressed({}, 3.0, deep, 20.0, 1e-3).last_force.z();
  EXPECT_NEAR(pressed({3.0, 50.0}, 1.0, deep, 100.0, 1e-3).last_force.z(), elastic, 3e-3 * elastic);
  EXPECT_NEAR(pressed({3.0, 1e-3}, 1.0, deep, 2.0, 1e-2).last_force.z(), softer, 3e-3 * softer);
}

TEST(ViscousTissue, a_held_dent_relaxes_as_a_standard_linear_solid_does) {
  constexpr double deep = 4.0;
  NeedleInBlock held = pressed({3.0, kQuick_s}, 1.0, deep, 4000.0, 1e-3);
  const double at_once = deep / held.insertion->compliance().matrix()(2, 2);
  double time = 0.5e-3;  // since the middle of the fast motion
  for (const double wait : {0.01, 0.02, 0.05}) {
    held.wait(wait, 0.1e-3);
    time += wait;
    const double law = at_once * (1.0 + 2.0 * std::exp(-3.0 * time / kQuick_s)) / 3.0;
    EXPECT_NEAR(held.last_force.z(), law, 0.02 * law) << time;
  }
}

TEST(ViscousTissue, a_stuck_needle_moved_sideways_relaxes) {
  // Sideways, contacts are bilateral and the problem is linear: the tissue's first response is that of elastic tissue,
  // and the final one is up to r times softer, less so because the needle bends. The two tracks differ a little,
  // because a tip that pushed creeping tissue ahead of it has cut less far.
  NeedleInBlock run = pushed_in({3.0, kQuick_s}, 1e-3);
  NeedleInBlock elastic = pushed_in({}, 1e-3);
  run.wait(6.0 * kQuick_s);
  elastic.wait(6.0 * kQuick_s);
  const double at_rest = run.last_force.x();
  const double elastic_at_rest = elastic.last_force.x();
  run.sideways = elastic.sideways = Vec3(1.0, 0.0, 0.0);
  run.step(1e-5);
  elastic.step(1e-5);
  const double first = run.last_force.x() - at_rest;
  const double all = elastic.last_force.x() - elastic_at_rest;
  EXPECT_NEAR(first, all, 0.05 * all);
  run.wait(8.0 * kQuick_s);
  const double settled = run.last_force.x() - at_rest;
  EXPECT_LT(settled, 0.8 * all);
  EXPECT_GT(settled, all / 3.0);
}

TEST(ViscousTissue, springs_back_at_once_by_what_is_elastic_and_the_rest_relaxes) {
  NeedleInBlock run = pressed({3.0, 0.2}, 1.0, 4.0, 20.0, 1e-3);
  run.wait(2.0);
  const double force = run.last_force.z();
  const VecX held = run.insertion->displacement();
  run.go(-1.0, 5000.0, 1e-3);
  ASSERT_EQ(run.count(EventKind::withdrawn), 1);
  const VecX left = run.insertion->displacement();
  EXPECT_GT(force, 0.1);
  EXPECT_LT((left - 2.0 / 3.0 * held).norm(), 0.01 * held.norm()) << "a third was elastic";
  run.wait(0.2);
  EXPECT_LT((run.insertion->displacement() - std::exp(-1.0) * left).norm(), 5e-3 * left.norm());
}

TEST(ViscousTissue, the_needles_own_dent_does_not_creep_and_skin_breaks_at_nearly_the_same_dent_at_any_speed) {
  const auto broke = [](const Creep& creep, double speed) {
    BlockOptions options = creeping(creep, CouplingSettings::Method::near_field);
    NeedleInBlock run(options);
    run.aim({2.0, 3.0, 0.0}, Vec3::UnitZ(), 0.0);
    while (run.count(EventKind::puncture) == 0 && run.depth < 40.0) run.go(run.depth + 0.02, speed, 0.02 / speed);
    EXPECT_EQ(run.flags, 0u);
    return run.first(EventKind::puncture)->depth;
  };
  const double elastic = broke({}, 20.0);
  const double fast = broke({3.0, 0.5}, 500.0);
  const double slow = broke({3.0, 0.5}, 2.0);
  std::printf("skin breaks at a dent of %.2f mm in elastic tissue, %.2f fast, %.2f slow\n", elastic, fast, slow);
  EXPECT_NEAR(fast, elastic, 0.02 * elastic);
  EXPECT_GT(slow, fast);
  EXPECT_LT(slow, 1.25 * elastic) << "the wide part is a small part of a dent";
}

TEST(ViscousTissue, curves_of_different_time_steps_approach_each_other_to_first_order) {
  const auto curve = [](double dt) {
    BlockOptions options = creeping({3.0, 0.02});
    options.region_at = [](const Vec3&) { return 0; };
    NeedleInBlock run(options);
    run.aim({2.0, 3.0, 0.0});
    run.go(31.0, 20.0, dt);  // from −1 mm: a whole number of steps
    run.wait(0.08, dt);
    std::vector<double> forces;
    const auto stride = static_cast<std::size_t>(std::lround(8e-3 / dt));
    for (std::size_t k = stride - 1; k < run.forces.size(); k += stride) forces.push_back(run.forces[k]);
    return forces;
  };
  const auto finest = curve(0.5e-3);
  const auto rms = [&](const std::vector<double>& other) {
    double sum = 0.0;
    double peak = 0.0;
    const std::size_t count = std::min(other.size(), finest.size());
    for (std::size_t k = 0; k < count; ++k) {
      sum += std::pow(other[k] - finest[k], 2);
      peak = std::max(peak, std::abs(finest[k]));
    }
    return std::sqrt(sum / static_cast<double>(count)) / peak;
  };
  const double coarse = rms(curve(4e-3));
  const double fine = rms(curve(2e-3));
  std::printf("RMS of the curve's distance to dt 0.5 ms over its peak: dt 4 ms %.5f, dt 2 ms %.5f\n", coarse, fine);
  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(coarse / fine, (4.0 - 0.5) / (2.0 - 0.5), 0.5);  // the distance is c (dt − 0.5 ms)
}

// The needle pushed in through both organs, with the near field.
NeedleInBlock near_field_in(const Creep& creep, double dt, double stiffening_MPa) {
  BlockOptions options = creeping(creep, CouplingSettings::Method::near_field);
  for (RegionLaws& laws : options.laws) laws.stiffening_MPa = stiffening_MPa;
  NeedleInBlock run(options);
  run.aim({2.0, 3.0, 0.0});
  run.go(55.0, 20.0, dt);
  return run;
}

TEST(ViscousTissue, with_the_near_field_no_step_shows_a_force_that_is_not_there) {
  // With creep times of 5 to 200 ms, a dent recovers before, while, and long after the tip passes it.
  for (const double stiffening_MPa : {0.0, 0.06}) {
    const double elastic = near_field_in({}, 2e-3, stiffening_MPa).peak();
    for (const double creep_s : {0.005, 0.05, 0.2}) {
      for (const double dt : {1e-3, 4e-3}) {
        const NeedleInBlock run = near_field_in({3.0, creep_s}, dt, stiffening_MPa);
        EXPECT_GE(run.count(EventKind::puncture), 2);
        EXPECT_LT(run.peak(), 1.05 * elastic) << creep_s << " s, dt " << dt << ", stiffening " << stiffening_MPa;
        EXPECT_EQ(run.flags, 0u) << creep_s << " s, dt " << dt << ", stiffening " << stiffening_MPa;
      }
    }
  }
}

TEST(ViscousTissue, hand_force_balances_contact_forces_and_supports) {
  for (const auto method : {CouplingSettings::Method::embedded, CouplingSettings::Method::node_addition}) {
    NeedleInBlock run = pushed_in({3.0, kQuick_s}, 2e-3, method);
    Vec3 contacts = Vec3::Zero();
    for (const ContactState& contact : run.insertion->contacts()) contacts += contact.force;
    EXPECT_LT((run.report.hand_force_N - contacts).norm(), 1e-9 * contacts.norm());
    const auto nodes = run.insertion->nodes();
    Vec3 support = Vec3::Zero();
    for (Eigen::Index a = 0; a < nodes.support.size() / 3; ++a) support += nodes.support.segment<3>(3 * a);
    EXPECT_LT((support + contacts).norm(), 1e-9 * contacts.norm());
  }
}

TEST(ViscousTissue, comes_back_after_withdrawal_and_then_is_as_new) {
  NeedleInBlock run = pushed_in({3.0, kQuick_s}, 2e-3);
  run.go(-2.0, 40.0, 2e-3);
  ASSERT_EQ(run.count(EventKind::withdrawn), 1);
  const double left = run.insertion->displacement().cwiseAbs().maxCoeff();
  EXPECT_GT(left, 1e-3);
  run.wait(kQuick_s, 2e-3);
  EXPECT_NEAR(run.insertion->displacement().cwiseAbs().maxCoeff(), left * std::exp(-1.0), 0.02 * left);
  EXPECT_GT(run.insertion->compliance().points(), 1);
  run.wait(16.0 * kQuick_s, 2e-3);
  EXPECT_EQ(run.insertion->displacement().cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(run.insertion->compliance().points(), 1);
}

TEST(ViscousTissue, can_be_entered_again_before_it_has_relaxed) {
  NeedleInBlock run = pushed_in({3.0, kQuick_s}, 2e-3, CouplingSettings::Method::node_addition);
  run.go(-2.0, 40.0, 2e-3);
  ASSERT_EQ(run.count(EventKind::withdrawn), 1);
  run.go(30.0, 20.0, 2e-3);
  EXPECT_EQ(run.flags, 0u);
  EXPECT_EQ(run.count(EventKind::skin_contact), 2);
  run.go(-2.0, 40.0, 2e-3);
  run.wait(17.0 * kQuick_s, 2e-3);
  EXPECT_EQ(run.insertion->displacement().cwiseAbs().maxCoeff(), 0.0);
}

TEST(ViscousTissue, staggered_and_coupled_solvers_agree) {
  BlockOptions options = creeping({3.0, kQuick_s}, CouplingSettings::Method::node_addition);
  options.coupling.tolerance = 1e-9;  // the staggered solver leaves an error many times larger than this
  NeedleInBlock coupled(options);
  options.coupling.solver = CouplingSettings::Solver::staggered;
  NeedleInBlock staggered(options);
  double difference = 0.0;
  for (NeedleInBlock* run : {&coupled, &staggered}) {
    run->aim({2.0, 3.0, 0.0});
    run->go(20.0, 20.0, 4e-3);
    run->wait(0.1, 4e-3);
    run->go(10.0, 20.0, 4e-3);
  }
  ASSERT_EQ(coupled.forces.size(), staggered.forces.size());
  for (std::size_t k = 0; k < coupled.forces.size(); ++k)
    difference = std::max(difference, std::abs(coupled.forces[k] - staggered.forces[k]));
  EXPECT_LT(difference, 1e-7 * coupled.peak());
}

/// Displacement of the mesh by the forces that hold the tissue.
VecX displaced_by_forces(const NeedleInBlock& run) {
  VecX load = VecX::Zero(3 * run.tissue->displacement_nodes());
  for (const TissueForce& force : run.insertion->tissue_forces()) {
    const Shape shape = run.tissue->shape(force.at.tet, force.at.weights);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      load.segment<3>(3 * Eigen::Index{shape.node[i]}) += shape.weight[i] * force.force;
  }
  return run.tissue->solve(load);
}

TEST(ViscousTissue, has_forces_for_all_that_it_is_displaced_by_also_when_the_needle_is_out_or_in_again) {
  NeedleInBlock run(creeping({3.0, 0.5}, CouplingSettings::Method::near_field));
  run.aim({2.0, 3.0, 0.0});
  const auto expect_all = [&](const char* when) {
    const VecX u = run.insertion->mesh_displacement();
    EXPECT_GT(u.norm(), 1e-3) << when;
    EXPECT_LT((displaced_by_forces(run) - u).norm(), 1e-9 * u.norm()) << when;
  };
  run.go(0.5);
  expect_all("pressing");
  run.go(-2.0, 50.0);
  expect_all("lifted off before anything was cut");
  run.go(25.0);
  expect_all("deep");
  run.go(-2.0, 100.0);
  expect_all("out");
  run.go(12.0, 50.0);
  expect_all("in again");
}

TEST(ViscousTissue, steps_do_not_allocate) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "under a sanitizer the memory functions cannot be replaced";
  NeedleInBlock run(creeping({3.0, kQuick_s}, CouplingSettings::Method::near_field));
  run.aim({2.0, 3.0, 0.0});
  run.insertion->prepare(60.0);
  long allocations = 0;
  const auto move = [&](double to, double way) {
    for (; way > 0.0 ? run.depth < to : run.depth > to; run.depth += way) {
      run.insertion->prepare(60.0);
      const test::AllocationCount allocated;
      run.insertion->step(run.pose(), 1e-3);
      allocations += allocated.count();
    }
  };
  move(30.0, 0.02);
  move(-2.0, -0.1);
  move(1.0, 0.02);
  EXPECT_EQ(allocations, 0);
}

}  // namespace
}  // namespace stylet
