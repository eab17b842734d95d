// SPDX-License-Identifier: GPL-3.0-or-later
// The stages of a model that take long: tissue and compliance.
#include "planning.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/sim/model_stages.hpp"
#include "tissue_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace stylet {

namespace {

/// Compliance is precomputed this far beyond the planned depth, because the tip pushes tissue ahead of it.
constexpr double kBeyond_mm = 15.0;

constexpr const char* kPrepareAgain = "Prepare the model again (stylet prepare)";

/// Largest memory for the two copies of the full inverse that some engines keep.
constexpr double kLargestInverse_GB = 8.0;

/// Displacement nodes of some elements, ascending.
std::vector<Index> nodes_of(const Tissue& tissue, const std::vector<Index>& elements) {
  std::vector<Index> nodes;
  for (const Index t : elements) {
    const auto of_element = tissue.nodes_of(t);
    nodes.insert(nodes.end(), of_element.begin(), of_element.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The corridor around the ways of all needles.
Corridor corridor_of(const TetMesh& mesh, const std::vector<PlannedInsertion>& insertions,
                     const Scenario::Coupling& coupling) {
  std::vector<std::array<Vec3, 2>> ways;
  ways.reserve(insertions.size());
  for (const PlannedInsertion& insertion : insertions)
    ways.push_back({insertion.entry, insertion.entry + (insertion.depth_mm + kBeyond_mm) * insertion.direction});
  return find_corridor(mesh, ways, coupling.corridor_mm, coupling.corridor_nodes);
}

/// The ways of all needles, as long as the corridor.
std::vector<NeedleWay> ways_of(const std::vector<PlannedInsertion>& insertions) {
  std::vector<NeedleWay> ways;
  ways.reserve(insertions.size());
  for (const PlannedInsertion& insertion : insertions)
    ways.push_back({insertion.entry, insertion.direction, insertion.depth_mm + kBeyond_mm});
  return ways;
}

/// Whether the coupling needs the wide part of the compliance (SpreadCompliance): for tissue that creeps or stiffens.
bool knows_wide(const CouplingSettings& coupling, const std::vector<RegionLaws>& laws) {
  if (coupling.method != CouplingSettings::Method::near_field) return false;
  const auto stiffens = [](const RegionLaws& region) { return region.stiffening_MPa > 0.0; };
  return coupling.creep.is_any() || (knows_stiffening(coupling) && std::any_of(laws.begin(), laws.end(), stiffens));
}

}  // namespace

Result<BuiltTissue> build_tissue(const Scenario& scenario, TetMesh mesh, Topology topology, const RegionTissue& regions,
                                 const Supports& supports, const std::vector<PlannedInsertion>& insertions, bool later,
                                 const std::string& where, std::vector<std::string>& warnings,
                                 const Progress& progress) {
  Corridor corridor = corridor_of(mesh, insertions, scenario.coupling);
  BuiltTissue built;
  built.corridor_mm = std::max(0.0, corridor.radius_mm);
  const bool condensed = scenario.coupling.engine == CouplingSettings::Engine::condensed;
  if (condensed && corridor.radius_mm < scenario.coupling.corridor_mm) {
    warnings.push_back(fmt::format(
        "Compliance is prepared within {:.1f} mm of the planned path only: coupling.corridor_mm = {:g} would take more "
        "than coupling.corridor_nodes = {} nodes. Outside of that corridor the program solves for it when the needle "
        "comes near, and pauses or flags the step. Raise coupling.corridor_nodes for a wider corridor.",
        built.corridor_mm, scenario.coupling.corridor_mm, scenario.coupling.corridor_nodes));
  }
  const Element element = element_of(scenario, mesh.node_count());
  if (element != element_of(scenario, 0)) {
    warnings.push_back(
        fmt::format("Linear tetrahedra (tissue.element = \"p1\") are used on this mesh of {} nodes, more than {}, "
                    "because elements with averaged pressure would need too much memory. Linear tetrahedra are "
                    "somewhat too stiff if Poisson's ratio is near 0.5.",
                    mesh.node_count(), kMostAveraged));
  }
  const std::vector<Index> last = condensed ? std::move(corridor.nodes) : std::vector<Index>{};
  std::vector<Material> materials = materials_of(regions.parameters);
  report(progress, "factorising the tissue", 0.0);
  auto tissue = later ? Tissue::build_later(std::move(mesh), std::move(materials), supports.nodes, element, last)
                      : Tissue::build(std::move(mesh), std::move(materials), supports.nodes, progress, element, last);
  if (!tissue) return within(where, tissue.error());
  built.tissue = std::make_shared<const Tissue>(std::move(*tissue));
  built.topology = std::make_shared<const Topology>(std::move(topology));
  built.locator = std::make_shared<const Locator>(built.tissue->mesh(), *built.topology);
  built.corridor_elements = std::move(corridor.elements);
  return built;
}

Result<PreparedCompliance> prepare_compliance(const Scenario& scenario, const BuiltTissue& built,
                                              const std::vector<RegionLaws>& laws,
                                              const std::vector<PlannedInsertion>& insertions,
                                              std::optional<ModelCompliance> known, const std::string& where,
                                              const Progress& progress) {
  const CouplingSettings coupling = coupling_settings(scenario);
  const Tissue& tissue = *built.tissue;
  const auto corridor_dofs = static_cast<Eigen::Index>(3 * tissue.corridor().size());
  if (known && (known->store.rows() != corridor_dofs || known->store.cols() != corridor_dofs)) {
    return input_error(where,
                       fmt::format("the saved compliance has {} nodes, but the corridor has {}",
                                   known->store.rows() / 3, corridor_dofs / 3),
                       kPrepareAgain);
  }
  report(progress, "compliance", 0.0);
  PreparedCompliance prepared;
  prepared.store = std::make_shared<ComplianceStore>(
      built.tissue, known ? std::exchange(known->store, {}) : tissue.compliance_of_corridor(progress));
  if (coupling.engine != CouplingSettings::Engine::condensed) {
    const double dofs = tissue.free_dofs() + 3.0 * coupling.capacity;
    const double gigabytes = 2.0 * dofs * dofs * sizeof(double) * 1e-9;  // two copies: undeformed and current mesh
    if (gigabytes > kLargestInverse_GB) {
      return input_error(
          fmt::format("{}, coupling.engine = \"{}\"", where, word(scenario.coupling.engine)),
          fmt::format("the full inverse of a mesh of {} nodes takes {:.1f} GB, more than {:g} GB",
                      tissue.mesh().node_count(), gigabytes, kLargestInverse_GB),
          "Use engine = \"condensed\", which keeps only what the needle touches, or a coarser mesh (mesh.nodes)");
    }
    prepared.inverse = std::make_shared<const MatX>(paper::full_inverse(tissue, progress));
  }
  if (coupling.method == CouplingSettings::Method::near_field) {
    auto kernel = std::make_shared<MeshKernel>(built.tissue, *built.topology);
    const std::vector<Index> nodes = nodes_of(tissue, built.corridor_elements);
    if (!known) {
      kernel->add_nodes(nodes, progress);
    } else if (!kernel->add_nodes(nodes, known->kernel)) {
      return input_error(where, "the saved near field does not belong to this corridor", kPrepareAgain);
    }
    prepared.kernel = std::move(kernel);
  }
  if (!knows_wide(coupling, laws)) return prepared;
  const std::vector<NeedleWay> ways = ways_of(insertions);
  if (known && known->spread.size() > 0) {
    prepared.spread = SpreadCompliance::of(ways, std::move(known->spread));
    if (!prepared.spread) {
      return input_error(where, "the saved compliance along the needles' ways does not belong to these ways",
                         kPrepareAgain);
    }
  } else {
    auto spread = SpreadCompliance::solve(tissue, ways, progress);
    if (!spread) return within(where, spread.error());
    prepared.spread = std::make_shared<const SpreadCompliance>(std::move(*spread));
  }
  return prepared;
}

}  // namespace stylet
