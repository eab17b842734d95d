// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a needle with about 40 contacts, deep in a block of tissue, forwards and back, while callgrind counts the
// instructions of the steps. Run by test_step_instructions.py.
//   step_instructions CELLS    number of elements along the block's short edges
#include "stylet/geom/box_mesh.hpp"
#include "stylet/sim/simulation.hpp"

#include <cstdio>
#include <cstdlib>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION std::exit(77)
#define CALLGRIND_TOGGLE_COLLECT
#endif

using namespace stylet;

namespace {

constexpr double kDepth_mm = 95.0;
constexpr double kSpacing_mm = 2.3;
constexpr int kForwards = 150;   ///< steps inwards, over more than one contact spacing
constexpr int kBackwards = 100;  ///< steps outwards, in which every contact first sticks and then slides

Scenario scenario() {
  Scenario s;
  s.name = "block";
  s.patient.source = "block";
  s.fixed.outer = OuterSupport::sides;
  s.needle.length_mm = 160.0;
  s.coupling.spacing_mm = kSpacing_mm;
  s.coupling.corridor_mm = 2.0;
  s.tissue_model.element = ElementChoice::p1;  // fast to factorise; the cost of a step does not depend on it
  s.insertions.resize(1);
  s.insertions[0].entry_mm = {1.0, 1.5, -20.0};
  s.insertions[0].depth_mm = kDepth_mm + 5.0;
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  const int cells = argc > 1 ? std::atoi(argv[1]) : 6;
  TetMesh mesh = box_mesh({-30, -30, 0}, {30, 30, 120}, {cells, cells, 2 * cells}, 0.1);
  assign_regions(mesh, {"body", "prostate"}, [](const Vec3& x) { return (x - Vec3(0, 5, 60)).norm() < 20 ? 1 : 0; });
  const auto model = Model::compile(scenario(), std::move(mesh), "block");
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message().c_str());
    return 1;
  }
  Simulation simulation(*model);
  const PlannedInsertion& plan = (*model)->insertions().front();
  Pose base = plan.motion.at(0.0);
  simulation.place(base, plan.entry, plan.direction);
  const auto advance = [&](double way_mm, double dt) {
    base.origin += way_mm * plan.direction;
    simulation.prepare();
    simulation.step(base, dt);
  };
  while (simulation.last_step().base_depth_mm < kDepth_mm) advance(0.2, 10e-3);

  CALLGRIND_START_INSTRUMENTATION;
  unsigned flags = 0;
  int iterations = 0;
  int contacts = 0;
  for (int k = 0; k < kForwards + kBackwards; ++k) {
    base.origin += (k < kForwards ? 0.02 : -0.02) * plan.direction;
    simulation.prepare();
    CALLGRIND_TOGGLE_COLLECT;
    simulation.step(base, 1e-3);
    CALLGRIND_TOGGLE_COLLECT;
    flags |= simulation.last_step().flags;
    iterations += simulation.last_step().iterations;
    contacts = simulation.last_step().contacts;
  }
  std::printf("{\"nodes\": %d, \"steps\": %d, \"contacts\": %d, \"iterations\": %d, \"flags\": %u}\n",
              (*model)->mesh().node_count(), kForwards + kBackwards, contacts, iterations, flags);
  return 0;
}
