// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_patient.hpp"
#include "stylet/sim/display_field.hpp"
#include "support/count_allocations.hpp"

#include <numeric>
#include <random>

using namespace stylet;
using namespace stylet::test;

namespace {

std::shared_ptr<const Model> box_model() {
  static const std::shared_ptr<const Model> model = [] {
    Scenario s = box_scenario();
    s.insertions[0].depth_mm = 30.0;
    s.coupling.corridor_mm = 5.0;
    return compiled(s);
  }();
  return model;
}

/// A field that keeps every column, and a field with fewer columns.
std::shared_ptr<const DisplayField> field_with(int columns) {
  DisplayFieldOptions options;
  options.columns = columns;
  options.tolerance_mm_per_N = 0.0;
  const auto field = DisplayField::prepare(box_model(), options);
  EXPECT_TRUE(field.ok());
  return *field;
}
const DisplayField& exact() {
  static const auto field = field_with(100000);
  return *field;
}
const DisplayField& compressed() {
  static const auto field = field_with(120);
  return *field;
}

/// Points within 1 or 2 mm of the planned path, like contacts.
MaterialPoint point_near_way(std::mt19937& random) {
  std::uniform_real_distribution<double> any(0.0, 1.0);
  const PlannedInsertion& plan = box_model()->insertions()[0];
  while (true) {
    const Vec3 beside(3.0 * any(random) - 1.5, 3.0 * any(random) - 1.5, 0.0);
    const Vec3 x = plan.entry + plan.depth_mm * any(random) * plan.direction + beside;
    if (const auto at = box_model()->locator().find(x)) return *at;
  }
}

VecX exact_displacement(std::span<const TissueForce> forces) {
  const Tissue& tissue = box_model()->tissue();
  MatX f = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, 1);
  for (const TissueForce& force : forces) {
    const Shape shape = tissue.shape(force.at.tet, force.at.weights);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      f.col(0).segment<3>(3 * Eigen::Index{shape.node[i]}) += shape.weight[i] * force.force;
  }
  return tissue.solve(f);
}

std::vector<Index> all_nodes() {
  std::vector<Index> nodes(static_cast<std::size_t>(box_model()->mesh().node_count()));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

Eigen::Matrix3Xf shown(const DisplayField& field, std::span<const TissueForce> forces) {
  auto load = field.make_load();
  field.set(forces, load);
  const auto nodes = all_nodes();
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(nodes.size()));
  field.displacement(nodes, load, u);
  return u;
}

/// Largest error [mm] of a node's displacement.
double off_by(const Eigen::Matrix3Xf& u, const VecX& expected) {
  return (u.cast<double>() - expected.head(u.size()).reshaped(3, u.cols())).colwise().norm().maxCoeff();
}

}  // namespace

TEST(DisplayField, is_the_tissues_own_displacement_where_all_columns_are_kept) {
  EXPECT_EQ(exact().statistics().columns, exact().statistics().zone_dofs);
  EXPECT_EQ(exact().statistics().error_mm_per_N, 0.0);
  std::mt19937 random(1);
  std::normal_distribution<double> newton(0.0, 0.1);
  std::vector<TissueForce> forces(30);
  for (TissueForce& f : forces) f = {point_near_way(random), {newton(random), newton(random), newton(random)}};
  const VecX expected = exact_displacement(forces);
  EXPECT_LT(off_by(shown(exact(), forces), expected), 1e-5 * expected.cwiseAbs().maxCoeff());
}

TEST(DisplayField, error_stays_below_the_stated_one_with_fewer_columns) {
  const auto& s = compressed().statistics();
  ASSERT_EQ(s.columns, 120);
  ASSERT_GT(s.zone_dofs, s.columns);
  ASSERT_GT(s.error_mm_per_N, 1e-4) << "else there is nothing to test";
  std::mt19937 random(2);
  std::normal_distribution<double> newton(0.0, 1.0);
  double largest = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<TissueForce> forces(trial % 2 == 0 ? 1 : 20);
    for (TissueForce& f : forces) f = {point_near_way(random), {newton(random), newton(random), newton(random)}};
    double sum_N = 0.0;
    for (const TissueForce& f : forces) sum_N += f.force.norm();
    const double off = off_by(shown(compressed(), forces), exact_displacement(forces));
    EXPECT_LT(off, s.error_mm_per_N * sum_N);
    largest = std::max(largest, off / sum_N);
  }
  EXPECT_GT(largest, 1e-2 * s.error_mm_per_N) << "the statement says nothing";
}

TEST(DisplayField, is_exact_near_the_way_however_few_columns) {
  std::mt19937 random(3);
  const std::vector<TissueForce> forces{{point_near_way(random), {0.5, -0.3, 1.0}}};
  const VecX expected = exact_displacement(forces);
  const Eigen::Matrix3Xf u = shown(compressed(), forces);
  int near = 0;
  for (Index node = 0; node < u.cols(); ++node) {
    if (!box_model()->store()->has(node)) continue;
    ++near;
    EXPECT_LT((u.col(node).cast<double>() - expected.segment<3>(3 * Eigen::Index{node})).norm(),
              1e-4 * expected.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(near, 20);
}

TEST(DisplayField, is_exact_everywhere_for_forces_on_its_skeleton) {
  // Forces on a node whose three degrees of freedom are all kept.
  const Tissue& tissue = box_model()->tissue();
  int checked = 0;
  for (Index tet = 0; tet < tissue.mesh().tet_count() && checked < 8; ++tet) {
    for (int corner = 0; corner < 4; ++corner) {
      const Index node = tissue.mesh().tets[static_cast<std::size_t>(tet)][static_cast<std::size_t>(corner)];
      if (tissue.is_fixed(node) || !compressed().exact_on(node)) continue;
      const std::vector<TissueForce> forces{{{tet, Vec4::Unit(corner)}, {1.0, 1.0, 1.0}}};
      ++checked;
      const VecX expected = exact_displacement(forces);
      EXPECT_LT(off_by(shown(compressed(), forces), expected), 1e-4 * expected.cwiseAbs().maxCoeff());
    }
  }
  EXPECT_GT(checked, 0);
}

TEST(DisplayField, follows_an_insertion) {
  Simulation simulation(box_model());
  const PlannedInsertion& plan = box_model()->insertions()[0];
  simulation.place(plan.motion.at(0.0), plan.entry, plan.direction);
  auto load = exact().make_load();
  const auto nodes = all_nodes();
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(nodes.size()));
  std::vector<TissueForce> room(256);
  double largest = 0.0;
  for (double t = 0.0; t < plan.motion.duration_s(); t += 4e-3) {
    simulation.prepare();
    simulation.step(plan.motion.at(t), 4e-3);
    if (static_cast<int>(t / 4e-3) % 20 != 0) continue;
    const std::size_t count = simulation.insertion().tissue_forces(room);
    ASSERT_LE(count, room.size());
    exact().set({room.data(), count}, load);
    EXPECT_EQ(load.left_out_N(), 0.0);
    exact().displacement(nodes, load, u);
    const VecX expected = simulation.insertion().mesh_displacement();
    EXPECT_LT(off_by(u, expected), 1e-5 * std::max(1e-3, expected.cwiseAbs().maxCoeff()));
    largest = std::max(largest, expected.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 0.5);
}

TEST(DisplayField, says_what_it_cannot_show) {
  const PlannedInsertion& plan = box_model()->insertions()[0];
  const auto far = box_model()->locator().find(plan.entry + 20.0 * plan.direction + Vec3(-25, -25, 0));
  ASSERT_TRUE(far);
  auto load = exact().make_load();
  exact().set(std::vector<TissueForce>{{*far, {0.0, 3.0, 0.0}}}, load);
  EXPECT_EQ(load.shown_N(), 0.0);
  EXPECT_GT(load.left_out_N(), 0.0);
  exact().set({}, load);
  EXPECT_EQ(load.left_out_N(), 0.0);
  Eigen::Matrix3Xf u(3, 1);
  const Index node = 5;
  exact().displacement({&node, 1}, load, u);
  EXPECT_EQ(u.norm(), 0.0F);
}

TEST(DisplayField, reading_does_not_allocate) {
  if (!AllocationCount::available())
    GTEST_SKIP() << "under a sanitizer the memory functions cannot be replaced by counting ones";
  std::mt19937 random(4);
  std::vector<TissueForce> forces(40);
  for (TissueForce& f : forces) f = {point_near_way(random), {0.1, 0.2, 0.3}};
  const auto nodes = all_nodes();
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(nodes.size()));
  for (const DisplayField* field : {&exact(), &compressed()}) {
    auto load = field->make_load();
    const AllocationCount allocations;
    field->set(forces, load);
    field->displacement(nodes, load, u);
    EXPECT_EQ(allocations.count(), 0);
  }
}

TEST(DisplayField, needs_the_compliance_store) {
  Scenario s = box_scenario();
  s.coupling.method = CouplingSettings::Method::node_addition;
  s.coupling.engine = CouplingSettings::Engine::woodbury;
  const auto field = DisplayField::prepare(compiled(s));
  ASSERT_FALSE(field.ok());
  EXPECT_SAYS(field.error().message(), "condensed");
}
