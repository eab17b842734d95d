// SPDX-License-Identifier: GPL-3.0-or-later
#include "runner_parts.hpp"
#include "sim/box_patient.hpp"
#include "stylet/geom/slice.hpp"
#include "stylet/realtime/scripted_device.hpp"
#include "stylet/sim/display_field.hpp"

#include <atomic>
#include <numeric>

using namespace stylet;
using namespace stylet::test;

namespace {

std::shared_ptr<const Model> half_a_second() {
  static const std::shared_ptr<const Model> model = [] {
    Scenario s = box_scenario();
    s.insertions[0].depth_mm = 20.0;
    s.insertions[0].speed_mm_per_s = 60.0;
    return compiled(s);
  }();
  return model;
}

std::vector<Index> all_nodes() {
  std::vector<Index> nodes(static_cast<std::size_t>(half_a_second()->mesh().node_count()));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

}  // namespace

TEST(Display, shows_a_running_simulation_from_other_threads) {
  const auto field = DisplayField::prepare(half_a_second());
  ASSERT_TRUE(field.ok());
  auto body = SimulationSteppable::create(half_a_second());
  ASSERT_TRUE(body.ok());
  SimulationSteppable* simulation = body->get();
  RunnerSettings settings = plain_settings();
  settings.period_s = 4e-3;
  settings.late_after_s = 0.5;
  auto runner = RealtimeRunner::create(
      *std::move(body), std::make_unique<ScriptedDevice>(half_a_second()->insertions()[0].motion), settings);
  ASSERT_TRUE(runner.ok());

  // One display reads snapshots; another one in a second thread uses the same field for another picture.
  std::atomic<bool> over{false};
  std::thread other([&] {
    auto load = (*field)->make_load();
    Slicer slicer(half_a_second()->mesh());
    Eigen::Matrix3Xf u(3, half_a_second()->mesh().node_count());
    const std::vector<TissueForce> force{{{0, Vec4::Constant(0.25)}, {0, 0, 1}}};
    while (!over.load()) {
      (*field)->set(force, load);
      slicer.cut({0, 0, 30}, {1, 0, 0});
      (*field)->displacement(slicer.nodes(), load, u.leftCols(static_cast<Eigen::Index>(slicer.nodes().size())));
    }
  });
  const auto nodes = all_nodes();
  auto load = (*field)->make_load();
  std::vector<TissueForce> room(Snapshot::kForces);
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(nodes.size()));
  const double half = 0.25;  // the needle is inside and stops there, so the tissue stays deformed
  int frames = 0;
  float largest = 0.0F;
  ASSERT_TRUE((*runner)->start().ok());
  const bool came = comes_true([&] {
    if (!(*runner)->fetch_snapshot()) return false;
    const Snapshot& snapshot = (*runner)->snapshot();
    (*field)->set(tissue_forces(snapshot, room), load);
    (*field)->displacement(nodes, load, u);
    largest = std::max(largest, u.cwiseAbs().maxCoeff());
    ++frames;
    return snapshot.step.time_s > half;
  });
  (*runner)->stop();
  over.store(true);
  other.join();
  ASSERT_TRUE(came);
  EXPECT_GT(frames, 3);
  EXPECT_GT(largest, 0.1F);

  (*runner)->fetch_snapshot();
  const Snapshot& last = (*runner)->snapshot();
  EXPECT_EQ(last.forces_left_out, 0);
  (*field)->set(tissue_forces(last, room), load);
  EXPECT_EQ(load.left_out_N(), 0.0);
  (*field)->displacement(nodes, load, u);
  const VecX expected = simulation->simulation().insertion().mesh_displacement();
  EXPECT_LT((u.cast<double>() - expected.head(u.size()).reshaped(3, u.cols())).cwiseAbs().maxCoeff(), 1e-5)
      << "what is shown is what the last step left";
}
