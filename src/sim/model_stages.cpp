// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/model_stages.hpp"

#include "needle_choice.hpp"
#include "planning.hpp"
#include "stylet/core/nearest_name.hpp"
#include "stylet/needle/make_needle.hpp"
#include "stylet/sim/hole_map.hpp"
#include "stylet/sim/plausible.hpp"
#include "stylet/sim/tenting.hpp"
#include "tissue_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

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

}  // namespace

Result<> check_compilable(const Scenario& scenario, const TetMesh& mesh, const std::string& where) {
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
  return Ok{};
}

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

RegionTissue region_tissue(const Scenario& scenario, const TetMesh& mesh) {
  RegionTissue tissue;
  tissue.target = find_target(mesh);
  tissue.parameters = tissue_parameters(scenario, mesh);
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    const std::string& name = mesh.regions[r];
    const TissueParameters& p = tissue.parameters[r];
    RegionLaws laws;
    laws.cutting_N = p.cutting_N;
    laws.puncture_N = p.puncture_N;
    laws.stiffening_MPa = p.stiffening * p.young_kPa * 1e-3;
    laws.friction = {p.friction_static_N_per_m * 1e-3, p.friction_coulomb_N_per_m * 1e-3,
                     p.friction_viscous_Ns_per_m2 * 1e-6, p.friction_viscous_to_mm_per_s};
    laws.surrounding = is_surrounding(name);
    const bool in_target =
        std::find(tissue.target.begin(), tissue.target.end(), static_cast<int>(r)) != tissue.target.end();
    // The urethra runs through the gland and has no capsule of its own.
    laws.organ = in_target || name == "urethra" ? 0 : name.starts_with("rect") ? 1 : -1;
    tissue.laws.push_back(laws);
  }
  return tissue;
}

std::vector<PlannedInsertion> PlannedInsertions::all() const {
  std::vector<PlannedInsertion> all = own;
  all.insert(all.end(), staying.begin(), staying.end());
  return all;
}

Result<PlannedInsertions> plan_insertions(const Scenario& scenario, const TetMesh& mesh, const Topology& topology,
                                          const std::vector<int>& target,
                                          const std::vector<std::vector<MotionSample>>& motions,
                                          const std::string& where, std::vector<std::string>& warnings) {
  const Locator locator(mesh, topology);
  PlannedInsertions plans;
  double recorded_s = 0.0;
  for (std::size_t i = 0; i < scenario.insertions.size(); ++i) {
    const bool is_recorded = i < motions.size() && !motions[i].empty();
    auto planned = is_recorded ? follow(motions[i], i, scenario, locator, where)
                               : plan_insertion(scenario.insertions[i], i, scenario, locator, target, where);
    if (!planned) return planned.error();
    if (std::string head = from_the_head(fmt::format("insertion[{}]", i), planned->direction);
        is_recorded && !head.empty())
      warnings.push_back(std::move(head));
    if (is_recorded) recorded_s += planned->motion.duration_s();
    plans.own.push_back(std::move(*planned));
  }
  if (std::string takes_long = recorded_s > 0.0 ? long_work_warning(scenario, recorded_s) : ""; !takes_long.empty())
    warnings.push_back(std::move(takes_long));
  auto staying = plan_staying(scenario, locator, target, where);
  if (!staying) return staying.error();
  plans.staying = *std::move(staying);
  return plans;
}

Result<Supports> hold_tissue(const Scenario& scenario, const TetMesh& mesh, const Topology& topology,
                             const std::vector<PlannedInsertion>& insertions, RegionTissue& tissue,
                             const std::string& where) {
  std::vector<Vec3> entries, directions;
  for (const PlannedInsertion& insertion : insertions) {
    entries.push_back(insertion.entry);
    directions.push_back(insertion.direction);
  }
  auto supports = find_supports(mesh, topology, scenario.fixed, tissue.target, entries, directions);
  if (!supports) return within(where, supports.error());
  for (const int region : supports->rigid_regions) tissue.laws[static_cast<std::size_t>(region)].rigid = true;
  return supports;
}

std::vector<std::string> tissue_warnings(const Scenario& scenario, const std::vector<std::string>& regions,
                                         const RegionTissue& tissue) {
  std::vector<std::string> warnings;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (tissue.laws[r].rigid) continue;  // held tissue neither tents nor is cut
    for (auto& warning : tenting_warnings(regions[r], tissue.parameters[r], scenario.needle.diameter_mm))
      warnings.push_back(std::move(warning));
  }
  if (knows_stiffening(coupling_settings(scenario))) return warnings;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (tissue.parameters[r].stiffening == 0.0 || tissue.laws[r].rigid) continue;
    warnings.push_back(fmt::format(
        "tissue.{}: stiffening = {:g} has no effect: with coupling.method = \"{}\" and coupling.solver = "
        "\"{}\" the tissue under the tip is linear, and its dent is deeper. Use coupling.method = "
        "\"near-field\" and coupling.solver = \"coupled\".",
        regions[r], tissue.parameters[r].stiffening, word(scenario.coupling.method), word(scenario.coupling.solver)));
    break;  // one warning for the first such region is enough
  }
  return warnings;
}

}  // namespace stylet
