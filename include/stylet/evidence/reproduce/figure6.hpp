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

/// A method by which the same insertions are simulated.
struct Figure6Variant {
  std::string id;      ///< word for file names: "bcs_repositioning"
  std::string label;   ///< name on the page
  std::string method;  ///< this and the next two fields: scenario keys coupling.method, .rule and .engine
  std::string rule;
  std::string engine;
};

/// The paper's two methods (switches with node repositioning, Woodbury with node addition) and this program's default
/// for node addition.
std::vector<Figure6Variant> figure6_variants();

/// An event of an insertion.
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

/// All iterations of one variant, with all insertions one after the other.
struct Figure6Run {
  Figure6Variant variant;
  std::vector<Step> steps;             ///< step_us is the median processor time of the whole iteration over all runs
  std::vector<std::size_t> insertion;  ///< (steps) number of the insertion, from 0
  std::vector<int> remeshings;         ///< (steps) changes of the mesh in this iteration
  std::vector<Figure6Event> events;
  std::vector<Figure6Remesh> remeshes;
  double compliance_mb = 0.0;  ///< memory of the stored part of K⁻¹ at the end
  int not_converged = 0;       ///< steps that did not converge and kept the last iterate

  [[nodiscard]] double total_s() const;
  [[nodiscard]] double worst_s(bool with_remeshing) const;  ///< longest iteration that did, or did not, change the mesh
  [[nodiscard]] double median_s(bool with_remeshing) const;
};

/// The setting of figure 6 and the runs of all variants.
struct Figure6 {
  Index nodes = 0;
  Index tets = 0;
  Index free_dofs = 0;
  double dt_ms = 0.0;
  double speed_mm_per_s = 0.0;
  double spacing_mm = 0.0;              ///< distance between contacts, except where nodes are added on faces
  int repeats = 0;                      ///< runs of each variant
  std::vector<std::string> insertions;  ///< description of each insertion, in words
  std::vector<Figure6Run> runs;

  /// The run of a variant; there must be one.
  [[nodiscard]] const Figure6Run& run(const std::string& id) const;
};

/// The scenario of figure 6: two needles on different ways into the demo patient's prostate, in a mesh of the paper's
/// size (570 nodes) whose pubic side is held. Each goes in, waits, and comes out at constant speed.
/// @param quick one shorter insertion with a larger time step
Scenario figure6_scenario(bool quick);

/// Sideways drift of the base at its deepest point [mm] LPS. No hand moves perfectly straight, and without drift the
/// forces across the needle would be nearly zero.
Vec3 figure6_drift_mm(std::size_t insertion);

/// Compiles the patient for a variant.
/// @param mesh mesh of the scenario's patient
Result<std::shared_ptr<const Model>> figure6_model(const Scenario& scenario, const Figure6Variant& variant,
                                                   const TetMesh& mesh, const Progress& progress = {});

/// Simulates all insertions of a model and keeps every iteration.
/// @param times number of repeats. They differ only in their processor times; the median of each iteration is kept,
/// which suppresses disturbances by other programs
Result<Figure6Run> run_insertions(const std::shared_ptr<const Model>& model, const Figure6Variant& variant, int times,
                                  const Progress& progress = {});

}  // namespace stylet::reproduce
