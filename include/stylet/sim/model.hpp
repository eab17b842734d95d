// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model_stages.hpp"
#include "stylet/sim/own_parts.hpp"
#include "stylet/sim/recording.hpp"

namespace stylet {

/// A compiled scenario: mesh, stiffness factor, compliance near the planned paths, laws, supports. Immutable:
/// simulations in any threads may share it. When a needle leaves the planned corridor, its simulation adds compliance
/// to a copy of its own.
class Model {
 public:
  /// Compiles a scenario; takes seconds to minutes.
  /// @param mesh the patient's tetrahedra, with canonical names of regions
  /// @param motions recorded base motions, one per insertion; an empty one means that the plan is followed
  /// @param where name of the scenario in messages
  /// @param known result of an earlier compile() of the same scenario and mesh: the stiffness is then factorised only
  ///   when something needs compliance that `known` does not have. Sizes that do not fit are an error; the caller must
  ///   make sure that `known` belongs to this model.
  static Result<std::shared_ptr<const Model>> compile(const Scenario& scenario, TetMesh mesh, const std::string& where,
                                                      const std::vector<std::vector<MotionSample>>& motions = {},
                                                      const Progress& progress = {},
                                                      std::optional<ModelCompliance> known = {});

  /// The same model with parts that the calling program supplies: a needle model, a law of cutting. Everything that
  /// took long to compute is shared with this model. The scenario does not describe these parts, so the warnings name
  /// them, and the model cannot be saved.
  /// Errors: a needle that cannot be made, or whose length is not needle.length_mm.
  [[nodiscard]] Result<std::shared_ptr<const Model>> with(OwnParts parts) const;

  [[nodiscard]] const OwnParts& own_parts() const { return own_; }
  [[nodiscard]] const Scenario& scenario() const { return scenario_; }
  [[nodiscard]] const TetMesh& mesh() const { return built_.tissue->mesh(); }
  [[nodiscard]] const Tissue& tissue() const { return *built_.tissue; }
  [[nodiscard]] const Topology& topology() const { return *built_.topology; }
  [[nodiscard]] const Locator& locator() const { return *built_.locator; }
  /// Compliance among the nodes of the corridor.
  [[nodiscard]] const std::shared_ptr<const ComplianceStore>& store() const { return compliance_.store; }
  /// The full K⁻¹ for engines that keep it; otherwise empty.
  [[nodiscard]] const std::shared_ptr<const MatX>& inverse() const { return compliance_.inverse; }
  /// Kernel of the mesh near the needles' ways, for coupling.method = "near-field"; otherwise empty.
  [[nodiscard]] const std::shared_ptr<const MeshKernel>& kernel() const { return compliance_.kernel; }
  /// Compliance to forces that are spread widely, along the needles' ways, for coupling.method = "near-field" in tissue
  /// that stiffens or creeps; otherwise empty.
  [[nodiscard]] const std::shared_ptr<const SpreadCompliance>& spread() const { return compliance_.spread; }
  [[nodiscard]] const std::vector<RegionLaws>& laws() const { return regions_.laws; }
  [[nodiscard]] const CouplingSettings& coupling() const { return coupling_; }
  [[nodiscard]] const std::vector<PlannedInsertion>& insertions() const { return insertions_.own; }
  /// Needles that go in before all insertions and stay (procedure.stabilising): each through its hole as the first
  /// insertion would go through it. A program that steps a Simulation itself has to put them in.
  [[nodiscard]] const std::vector<PlannedInsertion>& staying() const { return insertions_.staying; }
  /// Radius [mm] around the planned paths within which compliance is precomputed: coupling.corridor_mm, or less if that
  /// radius holds more than coupling.corridor_nodes nodes.
  [[nodiscard]] double corridor_mm() const { return built_.corridor_mm; }
  [[nodiscard]] const std::vector<int>& target_regions() const { return regions_.target; }
  [[nodiscard]] const Supports& supports() const { return supports_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// A new, unloaded needle as the scenario describes it, in a guide hole if template.guide is set.
  [[nodiscard]] std::unique_ptr<Needle> make_needle() const;

  /// Description of this model for a report: parameters with their sources, supports, warnings.
  /// @param insertion index of the insertion whose entry and direction are given
  [[nodiscard]] RunInfo info(std::size_t insertion = 0) const;

 private:
  Model() = default;
  Model(const Model&) = default;
  Scenario scenario_;
  CouplingSettings coupling_;
  RegionTissue regions_;
  PlannedInsertions insertions_;
  Supports supports_;
  BuiltTissue built_;
  PreparedCompliance compliance_;
  std::vector<std::string> warnings_;
  OwnParts own_;
};

}  // namespace stylet
