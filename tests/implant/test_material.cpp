// SPDX-License-Identifier: GPL-3.0-or-later
// The material point at a place in the room, and the displacement of any material point.
#include "implant/drop_seed.hpp"
#include "sim/box_patient.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

using Displacement = Insertion::PointDisplacement;

TEST(MaterialAt, is_the_place_less_a_uniform_displacement) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-30.0, 30.0);
  for (int k = 0; k < 50; ++k) {
    const Vec3 place(number(random), number(random), number(random));
    const Vec3 u(0.2 * number(random), 0.2 * number(random), 0.2 * number(random));
    const auto found = material_at(place, [&](const Vec3&) { return Displacement{u, Vec3::Zero()}; });
    ASSERT_TRUE(found);
    EXPECT_LT((found->x - (place - u)).norm(), 1e-12);
  }
}

TEST(MaterialAt, is_the_place_itself_in_tissue_that_is_not_displaced) {
  const Vec3 place(3, -4, 12);
  const auto found = material_at(place, [](const Vec3&) { return Displacement{}; });
  ASSERT_TRUE(found);
  EXPECT_EQ(found->x, place);
}

TEST(MaterialAt, is_found_where_the_tissue_is_strained) {
  // A random linear field with strains up to 0.6, whose material point is known.
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int k = 0; k < 50; ++k) {
    Mat3 gradient;
    for (int i = 0; i < 9; ++i) gradient(i / 3, i % 3) = number(random);
    gradient *= 0.6 / gradient.norm();
    const Vec3 x(10 * number(random), 10 * number(random), 10 * number(random));
    const Vec3 place = x + gradient * x;
    const auto found = material_at(place, [&](const Vec3& at) { return Displacement{gradient * at, Vec3::Zero()}; });
    ASSERT_TRUE(found);
    EXPECT_LT((found->x - x).norm(), 1e-8);
  }
}

TEST(MaterialAt, is_unknown_where_the_displacement_is_unknown) {
  EXPECT_FALSE(material_at(Vec3::Zero(), [](const Vec3&) -> std::optional<Displacement> { return std::nullopt; }));
}

TEST(TissueOfCapsule, goes_back_with_the_tissue_by_its_displacement) {
  // A random linear field, whose material points are known, a part of which lasts.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int k = 0; k < 50; ++k) {
    Mat3 gradient;
    for (int i = 0; i < 9; ++i) gradient(i / 3, i % 3) = number(random);
    gradient *= 0.3 / gradient.norm();
    const Vec3 moved(3 * number(random), 3 * number(random), 3 * number(random));
    const Vec3 rest(10 * number(random), 10 * number(random), 10 * number(random));
    const Vec3 axis = Vec3(number(random), number(random), 1.0).normalized();
    const Mat3 F = Mat3::Identity() + gradient;
    const TissueAt tissue = tissue_of_capsule(F * rest + moved, axis, 4.5, [&](const Vec3& x) {
      return Displacement{gradient * x + moved, 0.25 * moved};
    });
    EXPECT_TRUE(tissue.is_known);
    EXPECT_LT((tissue.rest_mm - rest).norm(), 1e-6);
    EXPECT_EQ(tissue.lasting_mm, 0.25 * moved);
    EXPECT_LT((tissue.axis - (F.inverse() * axis).normalized()).norm(), 1e-6);
  }
}

TEST(TissueOfCapsule, stays_where_it_is_in_tissue_whose_displacement_is_unknown) {
  const Vec3 centre(1, 2, 3);
  const TissueAt tissue = tissue_of_capsule(centre, Vec3::UnitZ(), 4.5,
                                            [](const Vec3&) -> std::optional<Displacement> { return std::nullopt; });
  EXPECT_FALSE(tissue.is_known);
  EXPECT_EQ(tissue.rest_mm, centre);
  EXPECT_EQ(tissue.axis, Vec3::UnitZ());
}

/// A simulation whose needle is in the gland.
Simulation inserted(double depth_mm) {
  Scenario scenario = test::box_scenario();
  scenario.tissue_model.preset = TissuePreset::linear;
  scenario.insertions[0].depth_mm = depth_mm;
  Simulation simulation(test::compiled(scenario));
  const BaseMotion& motion = simulation.model().insertions()[0].motion;
  for (double t = 0.0; t < 0.6 * motion.duration_s(); t += 4e-3) {
    simulation.prepare();
    simulation.step(motion.at(t), 4e-3);
  }
  return simulation;
}

// The displacement of all nodes is computed in another way: by solving for it. In tissue that stiffens or creeps,
// pictures have the mesh's own far field, which depends on its elements, and contacts have one that does not.
TEST(DisplacementAt, of_a_node_is_that_of_the_picture_of_all_nodes) {
  Simulation simulation = inserted(40.0);
  const Insertion& insertion = simulation.insertion();
  const VecX u = insertion.displacement();
  const TetMesh& mesh = simulation.model().mesh();
  int compared = 0;
  double largest = 0.0;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
    const auto at = simulation.model().locator().find(x);
    if (!at || (x - Vec3(4, 7, 30)).norm() > 25.0) continue;
    bool beside_shaft = false;  // where contacts have pieces of shaft, pictures and contacts differ by definition
    for (const ContactState& contact : insertion.contacts())
      beside_shaft = beside_shaft || (contact.position - x).norm() < 6.0;
    const auto found = simulation.displacement_at(*at, x);
    if (!found || beside_shaft) continue;
    const Vec3 expected = u.segment<3>(3 * Eigen::Index{node});
    EXPECT_LT((found->whole - expected).norm(), 0.03 * u.lpNorm<Eigen::Infinity>()) << x.transpose();
    largest = std::max(largest, expected.norm());
    ++compared;
  }
  EXPECT_GT(compared, 5);
  EXPECT_GT(largest, 0.05);
}

TEST(DisplacementAt, is_zero_once_elastic_tissue_is_let_go_and_changes_nothing) {
  Scenario scenario = test::box_scenario();
  scenario.tissue_model.creep = 1.0;
  scenario.insertions[0].depth_mm = 30.0;
  const auto model = test::compiled(scenario);
  Simulation asked(model), alone(model);
  const BaseMotion& motion = model->insertions()[0].motion;
  for (double t = 0.0; t < motion.duration_s() + 0.1; t += 4e-3) {
    for (Simulation* simulation : {&asked, &alone}) {
      simulation->prepare();
      simulation->step(motion.at(t), 4e-3);
    }
    const Vec3 x(4, 7, 20);
    asked.displacement_at(*model->locator().find(x), x);
    ASSERT_NEAR(asked.last_step().force_axial_N, alone.last_step().force_axial_N, 1e-6);
  }
  ASSERT_EQ(asked.last_step().tip_state, TipState::air);
  for (const double z : {5.0, 15.0, 25.0}) {
    const Vec3 x(4, 7, z);
    const auto u = asked.displacement_at(*model->locator().find(x), x);
    ASSERT_TRUE(u);
    EXPECT_LT(u->whole.norm(), 1e-9);
  }
}

TEST(DisplacementAt, has_a_lasting_part_only_where_tissue_creeps) {
  Scenario scenario = test::box_scenario();
  scenario.insertions[0].depth_mm = 30.0;
  for (const double creep : {1.0, 4.0}) {
    scenario.tissue_model.creep = creep;
    Simulation simulation(test::compiled(scenario));
    const BaseMotion& motion = simulation.model().insertions()[0].motion;
    for (double t = 0.0; t < 0.5 * motion.duration_s(); t += 4e-3) {
      simulation.prepare();
      simulation.step(motion.at(t), 4e-3);
    }
    const Vec3 x(4, 7, 15);
    const auto u = simulation.displacement_at(*simulation.model().locator().find(x), x);
    ASSERT_TRUE(u);
    EXPECT_EQ(u->lasting.norm() > 0.0, creep > 1.0);
    EXPECT_GT((u->whole - u->lasting).norm(), 0.0);
  }
}

}  // namespace
}  // namespace stylet
