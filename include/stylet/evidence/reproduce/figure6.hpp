// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/sim/recording.hpp"
#include "stylet/sim/scenario.hpp"
#include "stylet/sim/simulation.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet::reproduce {

/// One way of carrying the same insertions out.
struct Figure6Variant {
  std::string id;      ///< word for file names: "bcs_repositioning"
  std::string label;   ///< for people
  std::string method;  ///< scenario keys coupling.method, .rule, .engine
  std::string rule;
  std::string engine;
};

/// The paper's two (switches with node repositioning, Woodbury with node addition) and this program's default.
std::vector<Figure6Variant> figure6_variants();

/// Something that happened to the needle.
struct Figure6Event {
  std::size_t iteration = 0;
  std::size_t insertion = 0;
  Event event;
};

/// A change of the mesh.
struct Figure6Remesh {
  std::size_t iteration = 0;
  std::size_t insertion = 0;
  RemeshEvent event;
};

/// All iterations of one variant, both insertions in a row.
struct Figure6Run {
  Figure6Variant variant;
  std::vector<Step> steps;             ///< step_us: processor time of the whole iteration, median of all runs
  std::vector<std::size_t> insertion;  ///< (steps) number of the insertion, from 0
  std::vector<int> remeshings;         ///< (steps) changes of the mesh in this iteration
  std::vector<Figure6Event> events;
  std::vector<Figure6Remesh> remeshes;
  double compliance_mb = 0.0;  ///< memory of what is kept of K⁻¹, at the end
  int not_converged = 0;       ///< steps that kept the last iterate

  [[nodiscard]] double total_s() const;
  [[nodiscard]] double worst_s(bool with_remeshing) const;  ///< largest iteration that changed the mesh, or did not
  [[nodiscard]] double median_s(bool with_remeshing) const;
};

/// What the insertions are, and every variant of them.
struct Figure6 {
  Index nodes = 0;
  Index tets = 0;
  Index free_dofs = 0;
  double dt_ms = 0.0;
  double speed_mm_per_s = 0.0;
  double spacing_mm = 0.0;              ///< between contacts, but where nodes are added on faces
  int repeats = 0;                      ///< runs of each variant
  std::vector<std::string> insertions;  ///< in words
  std::vector<Figure6Run> runs;

  /// The run of a variant; there must be one.
  [[nodiscard]] const Figure6Run& run(const std::string& id) const;
};

/// Two needles on different ways into the demo patient's prostate, meshed as the paper's (570 nodes), the pubic side
/// held; each goes in, waits, and comes out at constant speed. quick: one shorter insertion with a larger time step.
Scenario figure6_scenario(bool quick);

/// How far the base drifts sideways until it is at its deepest [mm] LPS: no hand is straight, and a straight one would
/// feel next to nothing across the needle.
Vec3 figure6_drift_mm(std::size_t insertion);

/// Compiles the patient for a variant.
/// @param mesh of the scenario's patient
Result<std::shared_ptr<const Model>> figure6_model(const Scenario& scenario, const Figure6Variant& variant,
                                                   const TetMesh& mesh, const Progress& progress = {});

/// Carries all insertions of a model out and keeps every iteration.
/// @param times how often all of it is done: the same each time but for the processor times, of which the median of
/// each iteration is kept, so that what else the machine did does not show
Result<Figure6Run> run_insertions(const std::shared_ptr<const Model>& model, const Figure6Variant& variant, int times,
                                  const Progress& progress = {});

}  // namespace stylet::reproduce
