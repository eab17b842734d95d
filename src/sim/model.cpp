// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/model.hpp"

#include "needle_choice.hpp"
#include "planning.hpp"
#include "stylet/core/nearest_name.hpp"
#include "stylet/coupling/near_field/needle_kernel.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/coupling/tip_dent.hpp"
#include "stylet/geom/flat_tets.hpp"
#include "stylet/needle/guided.hpp"
#include "stylet/needle/make_needle.hpp"
#include "stylet/sim/cutting_lag.hpp"
#include "stylet/sim/hole_map.hpp"
#include "stylet/sim/plausible.hpp"
#include "tissue_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace stylet {

namespace {

constexpr double kTentingMin_mm = 3.0;   ///< smallest plausible tenting
constexpr double kTentingMax_mm = 20.0;  ///< largest plausible tenting
constexpr double kLagMax_mm = 5.0;       ///< largest plausible cutting lag
/// Compliance is precomputed this far beyond the planned depth, because the tip pushes tissue ahead of it.
constexpr double kBeyond_mm = 15.0;

CouplingSettings coupling_settings(const Scenario& s) {
  CouplingSettings c;
  c.method = s.coupling.method;
  c.engine = s.coupling.engine;
  c.solver = s.coupling.solver;
  c.rule = s.coupling.rule;
  c.damping = s.coupling.damping;
  if (s.coupling.projection == Projection::nearest_node) {
    const int elements =
        s.needle.elements > 0 ? s.needle.elements : default_needle_elements(word(s.needle.model)).value();
    c.needle_node_mm = s.needle.length_mm / elements;
  }
  c.bevel.angle_rad = s.needle.bevel_deg * std::numbers::pi / 180.0;
  c.bevel.law = s.needle.bevel_law;
  c.bevel.force_ratio = s.needle.bevel_force_ratio;
  c.spacing_mm = s.coupling.spacing_mm;
  c.needle_radius_mm = 0.5 * s.needle.diameter_mm;
  c.merge_mm = s.needle.diameter_mm;
  c.join_mm = s.needle.diameter_mm;
  c.tip_viscosity_Ns_per_mm = s.coupling.tip_viscosity_Ns_per_m * 1e-3;
  c.bone_damping_s = s.coupling.bone_damping_ms * 1e-3;
  c.grazing_cos = std::cos(s.coupling.grazing_deg * std::numbers::pi / 180.0);
  c.creep = {creep_of(s), s.tissue_model.creep_s};
  c.capacity = s.coupling.contacts;
  c.spare_nodes = s.coupling.spare_nodes;
  c.tolerance = s.coupling.tolerance;
  c.axial_compliance_mm_per_N = axial_compliance(s.needle);
  return c;
}

/// Number of point loads of a needle with `capacity` shaft contacts: the tip and a guide add one each.
int needle_loads(int capacity) { return capacity + 2; }

Result<std::unique_ptr<Needle>> build_needle(const Scenario::NeedleChoice& n, int capacity) {
  const auto section = needle_section(n);
  if (!section) return section.error();
  return make_needle(word(n.model), *section, n.elements, needle_loads(capacity));
}

constexpr const char* kPrepareAgain = "Prepare the model again (stylet prepare)";

/// Largest memory for the two copies of the full inverse that some engines keep.
constexpr double kLargestInverse_GB = 8.0;

/// The insertion of a recorded motion, which has to start with the tip outside of the patient.
Result<PlannedInsertion> follow(const std::vector<MotionSample>& motion, std::size_t number, const Scenario& scenario,
                                const Locator& locator, const std::string& where) {
  const double length = scenario.needle.length_mm;
  const auto tip_of = [&](const Pose& base) { return Vec3(base.origin + length * (base.rotation * Vec3::UnitZ())); };
  PlannedInsertion recorded;
  recorded.name = fmt::format("recorded motion {}", number + 1);
  recorded.motion = BaseMotion(motion);
  recorded.recorded = true;
  const Pose& first = motion.front().base;
  recorded.direction = first.rotation * Vec3::UnitZ();
  const Vec3 tip = tip_of(first);
  if (locator.find(tip)) {
    return input_error(
        fmt::format("{}, insertion[{}].motion", where, number),
        fmt::format("the recorded motion starts with the tip inside the patient, at ({:.1f}, {:.1f}, {:.1f}) mm",
                    tip.x(), tip.y(), tip.z()),
        "Start the recording with the needle outside, and check needle.length_mm");
  }
  constexpr double look_mm = 1000.0;
  const auto entry = locator.first_entry(tip, tip + look_mm * recorded.direction);
  recorded.entry = entry ? Vec3(tip + entry->t * look_mm * recorded.direction) : tip;
  for (const MotionSample& sample : motion) {
    recorded.depth_mm = std::max(recorded.depth_mm, (tip_of(sample.base) - recorded.entry).dot(recorded.direction));
  }
  if (scenario.grid.guide && recorded.depth_mm > deepest_mm(scenario)) {
    return input_error(
        fmt::format("{}, insertion[{}].motion", where, number),
        fmt::format("the recorded motion is {:.1f} mm deep and would push the base through the template, which allows "
                    "{:.1f} mm",
                    recorded.depth_mm, deepest_mm(scenario)),
        "Use a longer needle (needle.length_mm), a smaller template.distance_mm, or template.guide = false");
  }
  return recorded;
}

/// The needles that stay: each through its hole as the first insertion would go through it, without coming out.
Result<std::vector<PlannedInsertion>> plan_staying(const Scenario& scenario, const Locator& locator,
                                                   const std::vector<int>& target, const std::string& where) {
  std::vector<PlannedInsertion> staying;
  for (const std::string& hole : scenario.procedure.stabilising) {
    InsertionPlan plan = plan_through(scenario.insertions.front(), hole);
    plan.retract = false;
    auto planned = plan_insertion(plan, 0, scenario, locator, target, where);
    if (!planned) {
      Error error = planned.error();
      error.where = fmt::format("{}, procedure.stabilising, hole {}", where, hole);
      return error;
    }
    staying.push_back(std::move(*planned));
  }
  return staying;
}

std::vector<PlannedInsertion> all_of(const std::vector<PlannedInsertion>& own,
                                     const std::vector<PlannedInsertion>& staying) {
  std::vector<PlannedInsertion> all = own;
  all.insert(all.end(), staying.begin(), staying.end());
  return all;
}

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

/// Displacement [mm] of tissue under a force on the tip: a linear part on the scale of organs and a dent on the scale
/// of the needle, which stiffens.
double pressed_mm(const TissueParameters& t, double force_N, double needle_diameter_mm, const NearSurface& skin) {
  const Material material{t.young_kPa * 1e-3, t.poisson};
  const Medium medium{material.mu(), t.poisson};
  const NeedleKernel needle{.radius_mm = 0.5 * needle_diameter_mm};
  const auto moves = [&](double epsilon) {
    return skin.inwards.dot(tip_kernel(skin, {}, epsilon, medium) * skin.inwards);
  };
  const double organs = moves(NeedleKernel::kScale_mm);
  const double dent = moves(needle.own_tip_epsilon(skin, {}, t.poisson)) - organs;
  return organs * force_N + DentLaw{dent, t.stiffening * material.young_MPa}.depth(force_N);
}

/// The error with the scenario's name in front of its place.
Error named(Error error, const std::string& where) {
  error.where = where + ", " + error.where;
  return error;
}

}  // namespace

double tenting_mm(const TissueParameters& t, double force_N, double needle_diameter_mm) {
  return pressed_mm(t, force_N, needle_diameter_mm, {.depth = 0.0, .share = 1.0});
}

double cutting_lag_mm(const TissueParameters& t, double force_N, double needle_diameter_mm) {
  return pressed_mm(t, force_N, needle_diameter_mm, {});
}

std::vector<std::string> tenting_warnings(const std::string& region, const TissueParameters& t,
                                          double needle_diameter_mm) {
  std::vector<std::string> warnings;
  const std::string stiffening = t.stiffening > 0.0 ? fmt::format(" and stiffening = {:g}", t.stiffening) : "";
  const double tenting = tenting_mm(t, t.puncture_N, needle_diameter_mm);
  if (t.puncture_N > 0.0 && (tenting < kTentingMin_mm || tenting > kTentingMax_mm)) {
    warnings.push_back(fmt::format(
        "tissue.{}: puncture_N = {:g} with young_kPa = {:g}{} means {:.1f} mm of tenting before the surface "
        "breaks; {:g} to {:g} mm is plausible. Change them together.",
        region, t.puncture_N, t.young_kPa, stiffening, tenting, kTentingMin_mm, kTentingMax_mm));
  }
  const double lag = cutting_lag_mm(t, t.cutting_N, needle_diameter_mm);
  if (lag > kLagMax_mm) {
    warnings.push_back(fmt::format(
        "tissue.{}: cutting_N = {:g} with young_kPa = {:g}{} means a cutting lag of {:.1f} mm: the tip cuts that far "
        "behind the place to which it is pushed; at most {:g} mm is plausible. Change them together.",
        region, t.cutting_N, t.young_kPa, stiffening, lag, kLagMax_mm));
  }
  return warnings;
}

Result<std::shared_ptr<const Model>> Model::compile(const Scenario& scenario, TetMesh mesh, const std::string& where,
                                                    const std::vector<std::vector<MotionSample>>& motions,
                                                    const Progress& progress, std::optional<ModelCompliance> known) {
  if (auto checked = check_scenario(scenario, where); !checked) return checked.error();
  if (auto checked = check_has_insertion(scenario, where); !checked) return checked.error();
  if (auto checked = check_mesh(mesh, scenario.patient.source); !checked) return checked.error();
  for (const auto& [name, parameters] : scenario.tissue) {
    if (mesh.region_index(name) >= 0) continue;
    const std::string near = nearest_name(name, mesh.regions);
    return input_error(
        fmt::format("{}, [tissue.{}]", where, name),
        fmt::format("the patient has no region '{}' (there are: {})", name, fmt::join(mesh.regions, ", ")),
        fmt::format("{} patient.regions sets the names of structures and labels",
                    near.empty() ? "Use one of these names;" : fmt::format("Did you mean '{}'?", near)));
  }

  std::shared_ptr<Model> model(new Model);
  model->scenario_ = scenario;
  if (const auto needle = build_needle(scenario.needle, scenario.coupling.contacts); !needle)
    return named(needle.error(), where);
  model->coupling_ = coupling_settings(scenario);
  model->target_ = find_target(mesh);

  model->tissue_parameters_ = tissue_parameters(scenario, mesh);
  std::vector<Material> materials = materials_of(model->tissue_parameters_);
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    const std::string& name = mesh.regions[r];
    const TissueParameters& p = model->tissue_parameters_[r];
    RegionLaws laws;
    laws.cutting_N = p.cutting_N;
    laws.puncture_N = p.puncture_N;
    laws.stiffening_MPa = p.stiffening * p.young_kPa * 1e-3;
    laws.friction = {p.friction_static_N_per_m * 1e-3, p.friction_coulomb_N_per_m * 1e-3,
                     p.friction_viscous_Ns_per_m2 * 1e-6, p.friction_viscous_to_mm_per_s};
    laws.surrounding = is_surrounding(name);
    const bool in_target =
        std::find(model->target_.begin(), model->target_.end(), static_cast<int>(r)) != model->target_.end();
    // The urethra runs through the gland and has no capsule of its own.
    laws.organ = in_target || name == "urethra" ? 0 : name.starts_with("rect") ? 1 : -1;
    model->laws_.push_back(laws);
  }

  model->warnings_ = warnings_before_start(scenario);
  if (std::string flat = nearly_flat_warning(mesh); !flat.empty()) model->warnings_.push_back(std::move(flat));

  // The insertions are planned before the supports, because outer faces near an entry stay free.
  Topology topology(mesh);
  std::vector<PlannedInsertion> insertions;
  std::vector<Vec3> entries;
  std::vector<Vec3> directions;
  double recorded_s = 0.0;
  {
    const Locator locator(mesh, topology);
    for (std::size_t i = 0; i < scenario.insertions.size(); ++i) {
      const bool is_recorded = i < motions.size() && !motions[i].empty();
      auto planned = is_recorded ? follow(motions[i], i, scenario, locator, where)
                                 : plan_insertion(scenario.insertions[i], i, scenario, locator, model->target_, where);
      if (!planned) return planned.error();
      if (std::string head = from_the_head(fmt::format("insertion[{}]", i), planned->direction);
          is_recorded && !head.empty())
        model->warnings_.push_back(std::move(head));
      if (is_recorded) recorded_s += planned->motion.duration_s();
      insertions.push_back(std::move(*planned));
    }
    if (std::string takes_long = recorded_s > 0.0 ? long_work_warning(scenario, recorded_s) : ""; !takes_long.empty())
      model->warnings_.push_back(std::move(takes_long));
    auto staying = plan_staying(scenario, locator, model->target_, where);
    if (!staying) return staying.error();
    model->insertions_ = {std::move(insertions), *std::move(staying)};
  }
  const std::vector<PlannedInsertion> all = all_of(model->insertions_.own, model->insertions_.staying);
  for (const PlannedInsertion& insertion : all) {
    entries.push_back(insertion.entry);
    directions.push_back(insertion.direction);
  }
  auto supports = find_supports(mesh, topology, scenario.fixed, model->target_, entries, directions);
  if (!supports) return named(supports.error(), where);
  model->supports_ = std::move(*supports);
  for (const int region : model->supports_.rigid_regions) model->laws_[static_cast<std::size_t>(region)].rigid = true;
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    if (model->laws_[r].rigid) continue;  // held tissue neither tents nor is cut
    for (auto& warning : tenting_warnings(mesh.regions[r], model->tissue_parameters_[r], scenario.needle.diameter_mm))
      model->warnings_.push_back(std::move(warning));
  }

  if (!knows_stiffening(model->coupling_)) {
    for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
      if (model->tissue_parameters_[r].stiffening == 0.0 || model->laws_[r].rigid) continue;
      model->warnings_.push_back(
          fmt::format("tissue.{}: stiffening = {:g} has no effect: with coupling.method = \"{}\" and coupling.solver = "
                      "\"{}\" the tissue under the tip is linear, and its dent is deeper. Use coupling.method = "
                      "\"near-field\" and coupling.solver = \"coupled\".",
                      mesh.regions[r], model->tissue_parameters_[r].stiffening, word(scenario.coupling.method),
                      word(scenario.coupling.solver)));
      break;  // one warning for the first such region is enough
    }
  }

  const Corridor corridor = corridor_of(mesh, all, scenario.coupling);
  model->corridor_mm_ = std::max(0.0, corridor.radius_mm);
  const bool near_field = model->coupling_.method == CouplingSettings::Method::near_field;
  const bool condensed = model->coupling_.engine == CouplingSettings::Engine::condensed;
  if (condensed && corridor.radius_mm < scenario.coupling.corridor_mm) {
    model->warnings_.push_back(fmt::format(
        "Compliance is prepared within {:.1f} mm of the planned path only: coupling.corridor_mm = {:g} would take more "
        "than coupling.corridor_nodes = {} nodes. Outside of that corridor the program solves for it when the needle "
        "comes near, and pauses or flags the step. Raise coupling.corridor_nodes for a wider corridor.",
        model->corridor_mm_, scenario.coupling.corridor_mm, scenario.coupling.corridor_nodes));
  }
  const Element element = element_of(scenario, mesh.node_count());
  if (element != element_of(scenario, 0)) {
    model->warnings_.push_back(
        fmt::format("Linear tetrahedra (tissue.element = \"p1\") are used on this mesh of {} nodes, more than {}, "
                    "because elements with averaged pressure would need too much memory. Linear tetrahedra are "
                    "somewhat too stiff if Poisson's ratio is near 0.5.",
                    mesh.node_count(), kMostAveraged));
  }
  const std::vector<Index> last = condensed ? corridor.nodes : std::vector<Index>{};
  report(progress, "factorising the tissue", 0.0);
  auto tissue =
      known ? Tissue::build_later(std::move(mesh), std::move(materials), model->supports_.nodes, element, last)
            : Tissue::build(std::move(mesh), std::move(materials), model->supports_.nodes, progress, element, last);
  if (!tissue) return named(tissue.error(), where);
  model->tissue_ = std::make_shared<const Tissue>(std::move(*tissue));
  const auto corridor_dofs = static_cast<Eigen::Index>(3 * model->tissue_->corridor().size());
  if (known && (known->store.rows() != corridor_dofs || known->store.cols() != corridor_dofs)) {
    return input_error(where,
                       fmt::format("the saved compliance has {} nodes, but the corridor has {}",
                                   known->store.rows() / 3, corridor_dofs / 3),
                       kPrepareAgain);
  }
  model->topology_ = std::make_shared<const Topology>(std::move(topology));
  model->locator_ = std::make_shared<const Locator>(model->tissue_->mesh(), *model->topology_);
  report(progress, "compliance", 0.0);
  model->store_ = std::make_shared<ComplianceStore>(
      model->tissue_, known ? std::exchange(known->store, {}) : model->tissue_->compliance_of_corridor(progress));
  if (!condensed) {
    const double dofs = model->tissue_->free_dofs() + 3.0 * model->coupling_.capacity;
    const double gigabytes = 2.0 * dofs * dofs * sizeof(double) * 1e-9;  // two copies: undeformed and current mesh
    if (gigabytes > kLargestInverse_GB) {
      return input_error(
          fmt::format("{}, coupling.engine = \"{}\"", where, word(scenario.coupling.engine)),
          fmt::format("the full inverse of a mesh of {} nodes takes {:.1f} GB, more than {:g} GB",
                      model->mesh().node_count(), gigabytes, kLargestInverse_GB),
          "Use engine = \"condensed\", which keeps only what the needle touches, or a coarser mesh (mesh.nodes)");
    }
    model->inverse_ = std::make_shared<const MatX>(paper::full_inverse(*model->tissue_, progress));
  }
  if (near_field) {
    auto kernel = std::make_shared<MeshKernel>(model->tissue_, *model->topology_);
    const std::vector<Index> nodes = nodes_of(*model->tissue_, corridor.elements);
    if (!known) {
      kernel->add_nodes(nodes, progress);
    } else if (!kernel->add_nodes(nodes, known->kernel)) {
      return input_error(where, "the saved near field does not belong to this corridor", kPrepareAgain);
    }
    model->near_field_.kernel = std::move(kernel);
  }
  if (knows_wide(model->coupling_, model->laws_)) {
    const std::vector<NeedleWay> ways = ways_of(all);
    if (known && known->spread.size() > 0) {
      model->near_field_.spread = SpreadCompliance::of(ways, std::move(known->spread));
      if (!model->near_field_.spread)
        return input_error(where, "the saved compliance along the needles' ways does not belong to these ways",
                           kPrepareAgain);
    } else {
      auto spread = SpreadCompliance::solve(*model->tissue_, ways, progress);
      if (!spread) return named(spread.error(), where);
      model->near_field_.spread = std::make_shared<const SpreadCompliance>(std::move(*spread));
    }
  }
  return std::shared_ptr<const Model>(std::move(model));
}

Result<std::shared_ptr<const Model>> Model::with(OwnParts parts) const {
  std::shared_ptr<Model> model(new Model(*this));
  const auto warn = [&](const char* what, const std::string& name) {
    model->warnings_.push_back(fmt::format(
        "{} \"{}\" is a part of the program that made this model. The scenario does not describe it, so the "
        "stylet program computes other results from this scenario.",
        what, name));
  };
  if (parts.needle) {
    const auto section = needle_section(scenario_.needle);
    if (!section) return section.error();
    const auto needle = parts.needle(*section, needle_loads(coupling_.capacity));
    if (!needle) return needle.error();
    if (*needle == nullptr)
      return failure("own needle", "OwnParts::needle returned a null pointer", "Return a needle or an error");
    if (const double length = (*needle)->length(); std::abs(length - section->length_mm) > 1e-9 * section->length_mm) {
      return input_error("own needle \"" + (*needle)->model() + "\"",
                         fmt::format("it is {:g} mm long, and needle.length_mm is {:g}", length, section->length_mm),
                         "Give both the same length");
    }
    warn("The needle", (*needle)->model());
  }
  if (parts.cutting) warn("The law of cutting", parts.cutting->name());
  model->coupling_.cutting = parts.cutting;
  model->own_ = std::move(parts);
  return std::shared_ptr<const Model>(std::move(model));
}

std::unique_ptr<Needle> Model::make_needle() const {
  // Both succeed, since compile() and with() have built one.
  auto needle = own_.needle ? own_.needle(*needle_section(scenario_.needle), needle_loads(coupling_.capacity))
                            : build_needle(scenario_.needle, coupling_.capacity);
  if (!needle) return nullptr;
  if (!scenario_.grid.guide) return std::move(*needle);
  GuideHole hole;
  hole.clearance_mm = scenario_.grid.clearance_mm;
  return std::make_unique<GuidedNeedle>(std::move(*needle), hole, coupling_.capacity + 1);
}

}  // namespace stylet
