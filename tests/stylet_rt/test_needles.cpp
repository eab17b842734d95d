// SPDX-License-Identifier: GPL-3.0-or-later
// Several needles in one simulation, and the displaced surfaces, through the C interface.
#include "handle.hpp"
#include "sim/box_patient.hpp"
#include "stylet/core/flush_denormals.hpp"

#include <array>

using namespace stylet;
using namespace stylet::test;

namespace {

constexpr double kHandStep_s = 4e-3;
constexpr int kIn = 250;  // steps of a planned insertion in which the needle goes in

/// A model of the box patient with three needles beside each other.
ModelHandle three_ways() {
  Scenario scenario = test::box_scenario();
  scenario.insertions.resize(3, scenario.insertions.front());
  for (InsertionPlan& plan : scenario.insertions) plan.hole.reset();
  scenario.insertions[0].entry_mm = {0.0, 0.0, -20.0};
  scenario.insertions[1].entry_mm = {-5.0, 4.0, -20.0};
  scenario.insertions[2].entry_mm = {5.0, 4.0, -20.0};
  return ModelHandle(rt::make_handle(test::compiled(scenario)));
}

SimHandle created(const ModelHandle& model, std::uint32_t needles, std::uint32_t flags = 0) {
  const stylet_rt_options options{.struct_size = sizeof options, .insertion = 0, .flags = flags, .needles = needles};
  stylet_rt_sim* sim = nullptr;
  EXPECT_EQ(stylet_rt_sim_create(model.get(), &options, &sim, nullptr, 0), STYLET_RT_OK);
  return SimHandle(sim);
}

void put_in(stylet_rt_sim* sim, std::vector<double>& forces) {
  for (int k = 1; k <= kIn; ++k) {
    stylet_rt_pose base{};
    stylet_rt_result result{};
    ASSERT_EQ(stylet_rt_sim_planned_base(sim, k * kHandStep_s, &base), STYLET_RT_OK);
    ASSERT_EQ(stylet_rt_sim_step(sim, &base, kHandStep_s, &result), STYLET_RT_OK);
    forces.insert(forces.end(), result.hand_force_N, result.hand_force_N + 3);
  }
}

}  // namespace

TEST(NeedlesInC, hold_each_other_as_those_of_the_interface_in_cpp_to_the_last_bit) {
  const auto model = three_ways();
  for (const std::uint32_t flags : {0U, STYLET_RT_WORKER}) {
    const auto sim = created(model, 3, flags);
    std::vector<double> forces;
    for (int needle = 0; needle < 3; ++needle) {
      ASSERT_EQ(stylet_rt_sim_take_up(sim.get(), needle, needle, nullptr, 0), STYLET_RT_OK);
      EXPECT_EQ(stylet_rt_sim_held(sim.get()), needle);
      put_in(sim.get(), forces);
    }

    const FlushDenormals flush;
    Simulation expected(model->model, 3);
    std::vector<double> of_cpp;
    for (int needle = 0; needle < 3; ++needle) {
      const PlannedInsertion& plan = model->model->insertions()[static_cast<std::size_t>(needle)];
      ASSERT_TRUE(expected.take_up(needle).ok());
      expected.place(plan);
      for (int k = 1; k <= kIn; ++k) {
        const Vec3& force = expected.step(plan.motion.at(k * kHandStep_s), kHandStep_s).hand_force_N;
        of_cpp.insert(of_cpp.end(), force.data(), force.data() + 3);
      }
    }
    EXPECT_EQ(forces, of_cpp);
    for (int needle = 0; needle < 3; ++needle) {
      Vec3 hub, tip, base;
      std::array<double, 6> ends{};
      ASSERT_EQ(stylet_rt_sim_hub_force(sim.get(), needle, hub.data()), STYLET_RT_OK);
      EXPECT_EQ(hub, expected.insertion().hand_force_on(needle));
      EXPECT_GT(hub.norm(), 0.05) << "each needle is in the tissue";
      ASSERT_EQ(stylet_rt_sim_read_needle_of(sim.get(), needle, ends.data(), 2), STYLET_RT_OK);
      const Needle& same = expected.insertion().needle(needle);
      EXPECT_EQ(Vec3(ends.data() + 3), same.point(same.length()));
    }
  }
}

TEST(NeedlesInC, are_taken_up_again_where_they_rest) {
  const auto model = three_ways();
  const auto sim = created(model, 2);
  std::vector<double> forces;
  put_in(sim.get(), forces);
  stylet_rt_pose rests{};
  stylet_rt_result before{}, after{};
  ASSERT_EQ(stylet_rt_sim_planned_base(sim.get(), kIn * kHandStep_s, &rests), STYLET_RT_OK);
  ASSERT_EQ(stylet_rt_sim_read_result(sim.get(), &before), STYLET_RT_OK);
  ASSERT_EQ(stylet_rt_sim_take_up(sim.get(), 1, 1, nullptr, 0), STYLET_RT_OK);
  ASSERT_EQ(stylet_rt_sim_take_up(sim.get(), 0, -1, nullptr, 0), STYLET_RT_OK) << "it needs no insertion";
  ASSERT_EQ(stylet_rt_sim_read_result(sim.get(), &after), STYLET_RT_OK);
  EXPECT_EQ(after.base_depth_mm, before.base_depth_mm);
  ASSERT_EQ(stylet_rt_sim_step(sim.get(), &rests, kHandStep_s, &after), STYLET_RT_OK);
  EXPECT_NEAR(after.force_axial_N, before.force_axial_N, 0.1 * std::abs(before.force_axial_N));
}

TEST(NeedlesInC, that_are_not_there_are_refused_and_the_hand_keeps_its_needle) {
  const auto model = three_ways();
  const auto sim = created(model, 2);
  std::array<char, 300> error{};
  const auto refused = [&](int needle, int insertion) {
    EXPECT_EQ(stylet_rt_sim_take_up(sim.get(), needle, insertion, error.data(), error.size()), STYLET_RT_BAD_ARGUMENT);
    EXPECT_EQ(stylet_rt_sim_held(sim.get()), 0);
    return std::string(error.data());
  };
  EXPECT_SAYS(refused(2, 0), "stylet_rt_options.needles");
  EXPECT_SAYS(refused(-1, 0), "no needle of this number");
  EXPECT_SAYS(refused(1, 3), "insertion");
  EXPECT_EQ(stylet_rt_sim_take_up(nullptr, 0, 0, nullptr, 0), STYLET_RT_BAD_ARGUMENT);
  const auto three = created(model, 3);
  EXPECT_EQ(stylet_rt_sim_take_up(three.get(), 2, 0, error.data(), error.size()), STYLET_RT_BAD_ARGUMENT);
  EXPECT_SAYS(std::string(error.data()), "in the order");
  Vec3 force;
  std::array<double, 6> ends{};
  EXPECT_EQ(stylet_rt_sim_hub_force(sim.get(), 1, force.data()), STYLET_RT_BAD_ARGUMENT) << "not taken up yet";
  EXPECT_EQ(stylet_rt_sim_read_needle_of(sim.get(), 1, ends.data(), 2), STYLET_RT_BAD_ARGUMENT);
  EXPECT_EQ(stylet_rt_sim_held(nullptr), -1);
  const stylet_rt_options many{
      .struct_size = sizeof many, .insertion = 0, .flags = 0, .needles = STYLET_RT_MAX_NEEDLES + 1};
  stylet_rt_sim* none = nullptr;
  EXPECT_EQ(stylet_rt_sim_create(model.get(), &many, &none, error.data(), error.size()), STYLET_RT_BAD_ARGUMENT);
  EXPECT_SAYS(std::string(error.data()), "STYLET_RT_MAX_NEEDLES");
}

TEST(SurfacesInC, are_displaced_as_the_tissue_is) {
  const auto model = three_ways();
  const auto sim = created(model, 2);
  stylet_rt_display* made = nullptr;
  ASSERT_EQ(stylet_rt_display_create(model.get(), &made, nullptr, 0), STYLET_RT_OK);
  const DisplayHandle display(made);
  std::size_t count = 0, points = 0;
  ASSERT_EQ(stylet_rt_display_read_triangles(made, nullptr, 0, &count, &points), STYLET_RT_OK);
  std::vector<stylet_rt_triangle> triangles(count);
  ASSERT_EQ(stylet_rt_display_read_triangles(made, triangles.data(), count, &count, nullptr), STYLET_RT_OK);
  std::vector<double> rest(3 * points), moved(3 * points);
  ASSERT_EQ(stylet_rt_display_read_points(made, rest.data(), points, nullptr), STYLET_RT_OK);
  const auto at = [&](const std::vector<double>& of, int32_t k) { return Vec3(of.data() + 3 * std::size_t(k)); };

  // The outer triangles enclose the patient: their normals point outwards.
  double volume = 0.0, expected_volume = 0.0;
  for (const stylet_rt_triangle& t : triangles) {
    EXPECT_NE(t.inside, t.outside);
    if (t.outside < 0) volume += at(rest, t.corner[0]).dot(at(rest, t.corner[1]).cross(at(rest, t.corner[2]))) / 6.0;
  }
  const TetMesh& mesh = model->model->mesh();
  for (Index t = 0; t < mesh.tet_count(); ++t) expected_volume += tet_volume(mesh, t);
  EXPECT_NEAR(volume, expected_volume, 1e-9 * expected_volume);

  std::vector<double> forces;
  put_in(sim.get(), forces);
  ASSERT_EQ(stylet_rt_sim_take_up(sim.get(), 1, 1, nullptr, 0), STYLET_RT_OK);
  put_in(sim.get(), forces);
  double left_out_N = -1.0, most = 0.0, worst = 0.0;
  ASSERT_EQ(stylet_rt_display_take(made, sim.get()), STYLET_RT_OK);
  ASSERT_EQ(stylet_rt_display_read_points(made, moved.data(), points, &left_out_N), STYLET_RT_OK);
  EXPECT_LT(left_out_N, 1e-6);
  const VecX whole = sim->simulation.insertion().displacement();
  const auto shown = [&](const Vec3& x) {  // the node of the mesh that lies there at rest
    for (std::size_t k = 0; k < mesh.nodes.size(); ++k)
      if (mesh.nodes[k] == x) return Vec3(whole.segment<3>(3 * static_cast<Eigen::Index>(k)));
    ADD_FAILURE() << "a point is no node of the mesh";
    return Vec3(Vec3::Zero());
  };
  for (std::size_t k = 0; k < points; ++k) {
    const auto n = static_cast<int32_t>(k);
    const Vec3 way = at(moved, n) - at(rest, n);
    most = std::max(most, way.norm());
    worst = std::max(worst, (way - shown(at(rest, n))).norm());
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LT(worst, 0.02 * most);

  const auto other = three_ways();
  EXPECT_EQ(stylet_rt_display_take(made, created(other, 1).get()), STYLET_RT_BAD_ARGUMENT) << "of another model";
  EXPECT_EQ(stylet_rt_display_read_points(made, moved.data(), points - 1, nullptr), STYLET_RT_BAD_ARGUMENT);
  EXPECT_EQ(stylet_rt_display_create(nullptr, &made, nullptr, 0), STYLET_RT_BAD_ARGUMENT);
}
