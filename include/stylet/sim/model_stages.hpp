// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/coupling/insertion.hpp"
#include "stylet/sim/motion.hpp"
#include "stylet/sim/scenario.hpp"
#include "stylet/sim/supports.hpp"

#include <memory>
#include <optional>

/// The stages in which Model::compile() makes a model of a scenario and a mesh, and the values between them:
///   check_compilable → region_tissue → plan_insertions → hold_tissue → build_tissue → prepare_compliance
/// Each takes what it depends on and nothing else. `where` is the scenario's name in messages.
namespace stylet {

/// An insertion with entry point, direction, depth and motion determined.
struct PlannedInsertion {
  std::string name;                ///< template hole, or "needle 1", …
  Vec3 entry = Vec3::Zero();       ///< [mm] LPS skin point on the needle's line
  Vec3 direction = Vec3::UnitZ();  ///< unit, LPS
  double depth_mm = 0.0;           ///< largest base depth, measured from skin contact
  bool recorded = false;           ///< the base follows a recorded motion
  BaseMotion motion;
};

/// Refuses a scenario or a mesh that cannot be simulated, and tissue of regions that the mesh does not have.
Result<> check_compilable(const Scenario& scenario, const TetMesh& mesh, const std::string& where);

/// The settings of the coupling that follow from a scenario.
CouplingSettings coupling_settings(const Scenario& scenario);

/// The tissue of the regions of a mesh. Arrays are by region.
struct RegionTissue {
  std::vector<TissueParameters> parameters;
  std::vector<RegionLaws> laws;
  std::vector<int> target;  ///< numbers of the regions that form the target; may be empty
};
RegionTissue region_tissue(const Scenario& scenario, const TetMesh& mesh);

/// All insertions of a model.
struct PlannedInsertions {
  std::vector<PlannedInsertion> own;
  std::vector<PlannedInsertion> staying;  ///< through their holes as the first of `own` would go through them

  [[nodiscard]] std::vector<PlannedInsertion> all() const;
};
/// Plans the insertions of a scenario, and the needles that stay (procedure.stabilising).
/// @param motions recorded base motions, one per insertion; an empty one means that the plan is followed
/// @param warnings gets sentences about recorded motions
/// Errors: a needle that misses the patient or cannot reach its target; a recording that begins inside the patient.
Result<PlannedInsertions> plan_insertions(const Scenario& scenario, const TetMesh& mesh, const Topology& topology,
                                          const std::vector<int>& target,
                                          const std::vector<std::vector<MotionSample>>& motions,
                                          const std::string& where, std::vector<std::string>& warnings);

/// Finds the supports (find_supports()), and marks the regions that are held whole as rigid in `tissue`.
Result<Supports> hold_tissue(const Scenario& scenario, const TetMesh& mesh, const Topology& topology,
                             const std::vector<PlannedInsertion>& insertions, RegionTissue& tissue,
                             const std::string& where);

/// Warnings about tissue that tents or is cut implausibly, and about stiffening that has no effect.
std::vector<std::string> tissue_warnings(const Scenario& scenario, const std::vector<std::string>& regions,
                                         const RegionTissue& tissue);

/// The parts of a compiled model that take long to compute; they can be stored and passed to Model::compile().
struct ModelCompliance {
  MatX store;                  ///< [mm/N] (3c × 3c) K⁻¹ among the nodes of Tissue::corridor()
  std::vector<double> kernel;  ///< MeshKernel::numbers() of the corridor; empty without a near field
  MatX spread;                 ///< SpreadCompliance::matrix(); empty where nothing stiffens or creeps
};

/// The tissue with its supports, and the corridor in it for which compliance is prepared.
struct BuiltTissue {
  std::shared_ptr<const Tissue> tissue;
  std::shared_ptr<const Topology> topology;
  std::shared_ptr<const Locator> locator;
  std::vector<Index> corridor_elements;  ///< ascending
  /// Radius [mm] of the corridor: coupling.corridor_mm, or less if that radius holds more than coupling.corridor_nodes
  /// nodes.
  double corridor_mm = 0.0;
};
/// Assembles the tissue and factorises its stiffness.
/// @param later only when something needs it (Tissue::build_later())
/// @param warnings gets sentences about a narrow corridor and about elements that are not the usual ones
Result<BuiltTissue> build_tissue(const Scenario& scenario, TetMesh mesh, Topology topology, const RegionTissue& tissue,
                                 const Supports& supports, const std::vector<PlannedInsertion>& insertions, bool later,
                                 const std::string& where, std::vector<std::string>& warnings,
                                 const Progress& progress);

/// Compliance near the needles' ways.
struct PreparedCompliance {
  std::shared_ptr<const ComplianceStore> store;    ///< among the nodes of the corridor
  std::shared_ptr<const MatX> inverse;             ///< the full K⁻¹ for engines that keep it; otherwise empty
  std::shared_ptr<const MeshKernel> kernel;        ///< of the near field; otherwise empty
  std::shared_ptr<const SpreadCompliance> spread;  ///< to widely spread forces, in tissue that stiffens or creeps
};
/// Solves for the compliance, or takes it from `known`.
/// Errors: sizes of `known` that do not fit; a full inverse that is too large.
Result<PreparedCompliance> prepare_compliance(const Scenario& scenario, const BuiltTissue& built,
                                              const std::vector<RegionLaws>& laws,
                                              const std::vector<PlannedInsertion>& insertions,
                                              std::optional<ModelCompliance> known, const std::string& where,
                                              const Progress& progress);

}  // namespace stylet
