// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/coupling/insertion.hpp"
#include "stylet/sim/motion.hpp"
#include "stylet/sim/own_parts.hpp"
#include "stylet/sim/recording.hpp"
#include "stylet/sim/scenario.hpp"
#include "stylet/sim/supports.hpp"

#include <memory>
#include <optional>

namespace stylet {

/// An insertion with every open choice made.
struct PlannedInsertion {
  std::string name;                ///< template hole, or "needle 1", …
  Vec3 entry = Vec3::Zero();       ///< [mm] LPS skin point on the needle's line
  Vec3 direction = Vec3::UnitZ();  ///< unit, LPS
  double depth_mm = 0.0;           ///< of the base beyond skin contact
  bool recorded = false;           ///< follows a motion that was given
  BaseMotion motion;
};

/// What takes long to compute of a model.
struct ModelCompliance {
  MatX store;                  ///< [mm/N] (3c × 3c) K⁻¹ among the nodes of Tissue::corridor()
  std::vector<double> kernel;  ///< MeshKernel::numbers() of the corridor; empty without a near field
  MatX spread;                 ///< SpreadCompliance::matrix(); empty where nothing stiffens or creeps
};

/// A scenario compiled: mesh, stiffness factor, compliance near the planned paths, laws, supports. Immutable:
/// simulations in any threads may share it, and where a needle leaves the planned corridor its own copy of the
/// compliance grows.
class Model {
 public:
  /// @param mesh the patient's tetrahedra, regions by canonical names
  /// @param motions recorded base motions, one per insertion, empty where the plan is to be followed
  /// @param where what to call the scenario in messages
  /// @param known what compile() computed for the same scenario and mesh before: the stiffness is then factorised only
  ///   when something asks for what is not in it. Refused where the sizes do not fit; whether it belongs to the model
  ///   is the caller's to know.
  static Result<std::shared_ptr<const Model>> compile(const Scenario& scenario, TetMesh mesh, const std::string& where,
                                                      const std::vector<std::vector<MotionSample>>& motions = {},
                                                      const Progress& progress = {},
                                                      std::optional<ModelCompliance> known = {});

  /// The same model with parts of the program's own: a needle model, a law of cutting. Everything that took long to
  /// compute is shared with this model. The scenario does not describe these parts, so the warnings name them, and the
  /// model cannot be saved.
  /// Errors: a needle that cannot be made, or whose length is not needle.length_mm.
  [[nodiscard]] Result<std::shared_ptr<const Model>> with(OwnParts parts) const;

  [[nodiscard]] const OwnParts& own_parts() const { return own_; }
  [[nodiscard]] const Scenario& scenario() const { return scenario_; }
  [[nodiscard]] const TetMesh& mesh() const { return tissue_->mesh(); }
  [[nodiscard]] const Tissue& tissue() const { return *tissue_; }
  [[nodiscard]] const Topology& topology() const { return *topology_; }
  [[nodiscard]] const Locator& locator() const { return *locator_; }
  /// Of the corridor.
  [[nodiscard]] const std::shared_ptr<const ComplianceStore>& store() const { return store_; }
  /// The full K⁻¹, for engines that keep it; else empty.
  [[nodiscard]] const std::shared_ptr<const MatX>& inverse() const { return inverse_; }
  /// Kernel of the mesh near the needles' ways, where coupling.method = "near-field"; empty otherwise.
  [[nodiscard]] const std::shared_ptr<const MeshKernel>& kernel() const { return near_field_.kernel; }
  /// The compliance to spread forces along the needles' ways, where there is a near field in tissue that stiffens or
  /// creeps; empty otherwise.
  [[nodiscard]] const std::shared_ptr<const SpreadCompliance>& spread() const { return near_field_.spread; }
  [[nodiscard]] const std::vector<RegionLaws>& laws() const { return laws_; }
  [[nodiscard]] const CouplingSettings& coupling() const { return coupling_; }
  [[nodiscard]] const std::vector<PlannedInsertion>& insertions() const { return insertions_; }
  /// Radius around the planned ways in which compliance is there from the start [mm]: coupling.corridor_mm, or less
  /// where that has more than coupling.corridor_nodes.
  [[nodiscard]] double corridor_mm() const { return corridor_mm_; }
  [[nodiscard]] const std::vector<int>& target_regions() const { return target_; }
  [[nodiscard]] const Supports& supports() const { return supports_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// A needle of this model, unloaded; in a guide where the template is one.
  [[nodiscard]] std::unique_ptr<Needle> make_needle() const;

  /// What a report says about this model.
  /// @param insertion the one the entry and direction are of
  [[nodiscard]] RunInfo info(std::size_t insertion = 0) const;

 private:
  Model() = default;
  Model(const Model&) = default;
  Scenario scenario_;
  std::shared_ptr<const Tissue> tissue_;
  std::shared_ptr<const Topology> topology_;
  std::shared_ptr<const Locator> locator_;
  std::shared_ptr<const ComplianceStore> store_;
  std::shared_ptr<const MatX> inverse_;
  struct {
    std::shared_ptr<const MeshKernel> kernel;
    std::shared_ptr<const SpreadCompliance> spread;
  } near_field_;
  std::vector<RegionLaws> laws_;
  std::vector<TissueParameters> tissue_parameters_;  ///< by region
  CouplingSettings coupling_;
  double corridor_mm_ = 0.0;
  std::vector<PlannedInsertion> insertions_;
  std::vector<int> target_;
  Supports supports_;
  std::vector<std::string> warnings_;
  OwnParts own_;
};

/// Depth [mm] by which the surface of tissue of these parameters tents under a force [N] on a flat punch of the
/// needle's radius: F (1 − ν²) / (2 R E), or less where it stiffens (docs/theory/stiffening.md).
double tenting_mm(const TissueParameters& tissue, double force_N, double needle_diameter_mm);

/// What is wrong with a set of parameters before anything is simulated: tenting outside 5 … 20 mm, a cutting lag over
/// 5 mm. One sentence each.
std::vector<std::string> tenting_warnings(const std::string& region, const TissueParameters& tissue,
                                          double needle_diameter_mm);

}  // namespace stylet
