// SPDX-License-Identifier: GPL-3.0-or-later
// Runs every coupling method with every engine, solver and needle model on the same insertion and compares the results.
#include "box_patient.hpp"

#include <algorithm>
#include <map>

using namespace stylet;
using namespace stylet::test;

namespace {

Scenario scenario_with(const std::string& method, const std::string& engine, const std::string& solver,
                       const std::string& needle) {
  Scenario s = box_scenario();
  s.insertions[0].depth_mm = 24.0;
  s.insertions[0].dwell_s = 0.02;
  s.run.dt_ms = 5.0;
  s.coupling.method = choice<CouplingSettings::Method>(method).value();
  s.coupling.engine = choice<CouplingSettings::Engine>(engine).value();
  s.coupling.solver = choice<CouplingSettings::Solver>(solver).value();
  s.coupling.tolerance = 1e-9;  // the error after the staggered solver's slow iterations is many times larger
  s.needle.model = choice<NeedleModel>(needle).value();
  s.tissue_model.element = ElementChoice::p1;    // the engines with a full inverse need it
  s.tissue_model.preset = TissuePreset::linear;  // stiffening needs near-field and the coupled solver
  s.needle.elements = needle == "tet" ? 48 : 12;
  return s;
}

}  // namespace

class EveryMethod : public testing::TestWithParam<const char*> {};

TEST_P(EveryMethod, runs_to_the_same_events_and_forces_with_every_engine_solver_and_needle_or_says_why_not) {
  const char* method = GetParam();
  std::map<std::string, Summary> by_needle;  // results of the first engine and solver
  for (const char* engine : {"condensed", "woodbury", "bcs"}) {
    for (const char* solver : {"coupled", "staggered"}) {
      for (const char* needle : {"beam", "springs", "tet"}) {
        SCOPED_TRACE(std::string(method) + " " + engine + " " + solver + " " + needle);
        const Scenario scenario = scenario_with(method, engine, solver, needle);
        if (scenario.coupling.method == CouplingSettings::Method::node_repositioning &&
            scenario.coupling.engine == CouplingSettings::Engine::condensed) {
          const Error error = refused(scenario);
          EXPECT_SAYS(error.message(), "never changes the stiffness of the mesh");
          EXPECT_SAYS(error.cure, "\"woodbury\" or \"bcs\"");
          continue;
        }
        const Finished run(compiled(scenario));
        const auto [first, is_first] = by_needle.try_emplace(needle, run.summary);
        for (const std::string& warning : run.summary.warnings) EXPECT_FALSE(contains(warning, "steps:")) << warning;
        if (is_first) continue;
        EXPECT_NEAR(run.summary.peak_axial_N, first->second.peak_axial_N, 1e-6 * first->second.peak_axial_N);
        ASSERT_EQ(run.summary.events.size(), first->second.events.size());
        for (std::size_t k = 0; k < run.summary.events.size(); ++k) {
          EXPECT_EQ(run.summary.events[k].kind, first->second.events[k].kind);
          EXPECT_EQ(run.summary.events[k].time_s, first->second.events[k].time_s);
          // The force of a puncture belongs to the iterate at which the surface broke, not to a balance.
          const bool puncture = run.summary.events[k].kind == EventKind::puncture;
          EXPECT_NEAR(run.summary.events[k].force_N, first->second.events[k].force_N, puncture ? 1e-3 : 1e-5);
        }
        EXPECT_EQ(run.summary.mesh_changes.size(), first->second.mesh_changes.size());
      }
    }
  }
  for (const char* needle : {"springs", "tet"})
    EXPECT_NEAR(by_needle[needle].peak_axial_N, by_needle["beam"].peak_axial_N, 0.02 * by_needle["beam"].peak_axial_N);
}

INSTANTIATE_TEST_SUITE_P(Combinations, EveryMethod,
                         testing::Values("near-field", "node-addition", "node-repositioning", "embedded"),
                         [](const auto& method) {
                           std::string name = method.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Combinations, forces_at_the_needles_nearest_nodes_come_close_to_forces_where_they_act) {
  Scenario scenario = scenario_with("node-addition", "condensed", "staggered", "beam");
  const Finished exact(compiled(scenario));
  scenario.coupling.projection = Projection::nearest_node;
  const Finished nearest(compiled(scenario));
  EXPECT_NE(nearest.summary.peak_axial_N, exact.summary.peak_axial_N);
  EXPECT_NEAR(nearest.summary.peak_axial_N, exact.summary.peak_axial_N, 0.02 * exact.summary.peak_axial_N);

  scenario.coupling.solver = CouplingSettings::Solver::coupled;
  EXPECT_SAYS(refused(scenario).message(), "belongs to coupling.solver = \"staggered\"");
}

TEST(Combinations, a_full_inverse_that_would_not_fit_in_memory_is_refused_with_its_size) {
  Scenario scenario = box_scenario();
  scenario.coupling.engine = CouplingSettings::Engine::woodbury;
  TetMesh mesh = box_mesh({-30, -30, 0}, {30, 30, 60}, {24, 24, 24});
  assign_regions(mesh, {"body", "prostate"}, [](const Vec3& x) { return (x - Vec3(0, 5, 32)).norm() < 17 ? 1 : 0; });
  const Error error = refused(scenario, std::move(mesh));
  EXPECT_SAYS(error.message(), "15625 nodes takes");
  EXPECT_SAYS(error.cure, "engine = \"condensed\"");
}
