// SPDX-License-Identifier: GPL-3.0-or-later
#include "planning.hpp"
#include "stylet/sim/scenario.hpp"

#include <fmt/format.h>

namespace stylet {

namespace {

Result<> check_insertion(const Scenario& s, std::size_t number, const ScenarioPlace& place) {
  const InsertionPlan& p = s.insertions[number];
  const std::string name = fmt::format("insertion[{}]", number);
  const bool way_given = p.hole || p.entry_mm || p.direction || p.target_mm;
  if (!p.motion.empty()) {
    if (p.roll_deg != 0.0) {
      return input_error(place(name + ".roll_deg"), name + " has a recorded motion and roll_deg",
                         "Remove roll_deg, since the recorded motion turns the needle itself");
    }
    if (!way_given) return Ok{};
    return input_error(place(name + ".motion"), name + " has a recorded motion and a hole, entry, direction or target",
                       "Give the motion alone, or remove it");
  }
  if (p.hole && p.entry_mm)
    return input_error(place(name + ".hole"), name + " has both hole and entry_mm", "Give one of the two");
  if (!p.hole && !p.entry_mm) {
    return input_error(place(name), name + " has neither hole nor entry_mm",
                       "Say where the needle goes in, for example hole = \"D4\" or entry_mm = [10, 5, -80]");
  }
  if (p.hole) {
    if (const auto offset = s.grid.offset_mm(*p.hole); !offset) {
      return input_error(place(name + ".hole"), fmt::format("{}.hole = \"{}\": {}", name, *p.hole, offset.error().what),
                         offset.error().cure);
    }
    if (p.direction || p.target_mm) {
      return input_error(place(name + (p.direction ? ".direction" : ".target_mm")),
                         fmt::format("{} has a hole and a {}; a template holds the needle along +z", name,
                                     p.direction ? "direction" : "target_mm"),
                         "Use entry_mm instead of the hole, or let the template guide the needle");
    }
  }
  if (p.direction && p.target_mm) {
    return input_error(place(name + ".target_mm"), name + " has both direction and target_mm", "Give one of the two");
  }
  if (p.direction && Vec3(p.direction->data()).norm() < 1e-9) {
    return input_error(place(name + ".direction"), name + ".direction = [0, 0, 0] points nowhere",
                       "Give a direction such as [0, 0, 1]");
  }
  if (p.target_mm && (Vec3(p.target_mm->data()) - Vec3(p.entry_mm->data())).norm() < 1e-3) {
    return input_error(place(name + ".target_mm"), name + ": entry_mm and target_mm are the same point",
                       "Give two points of the needle's line");
  }
  if (!p.retract && number + 1 < s.insertions.size()) {
    return input_error(
        place(name + ".retract"),
        fmt::format("{}.retract = false leaves the needle in, and insertion[{}] follows", name, number + 1),
        "Let only the last insertion leave its needle in, since there is one needle");
  }
  const double reach = deepest_mm(s);
  if (p.depth_mm > reach) {
    const std::string outside =
        s.grid.guide ? fmt::format("{} mm and the template's distance, {} mm", kNeedleOutside_mm, s.grid.distance_mm)
                     : fmt::format("{} mm", kNeedleOutside_mm);
    return input_error(
        place(name + ".depth_mm"),
        fmt::format("{}.depth_mm = {} is more than the needle's length less {} ({})", name, p.depth_mm, outside, reach),
        "Use a longer needle (needle.length_mm) or a smaller depth");
  }
  return Ok{};
}

/// A plan is a file or a list of needles, and each needle has one place and one way to say its seeds.
Result<> check_plan(const Scenario& s, const ScenarioPlace& place) {
  const Scenario::ImplantPlan& plan = s.plan;
  if (!plan.file.empty() && !plan.needles.empty()) {
    return input_error(
        place("plan.file"),
        fmt::format("plan.file = \"{}\" is a plan, and there are {} [[plan.needle]]", plan.file, plan.needles.size()),
        "Give the plan as a file or as needles, not as both");
  }
  const Scenario::ImplantPlan fresh;
  if (plan.needles.empty()) {
    const bool of_needles = plan.label != fresh.label || plan.strength_U != fresh.strength_U ||
                            plan.prescription_Gy != fresh.prescription_Gy || plan.base_mm ||
                            plan.seed_length_mm != fresh.seed_length_mm ||
                            plan.spacer_length_mm != fresh.spacer_length_mm;
    if (of_needles) {
      return input_error(place("plan"),
                         "label, strength_U, prescription_Gy, base_mm, seed_length_mm and spacer_length_mm belong to "
                         "[[plan.needle]], and there is none",
                         "Add [[plan.needle]], or give these values in the file of the plan");
    }
  } else if (!plan.base_mm) {
    return input_error(place("plan"), "there are [[plan.needle]], and plan.base_mm is missing",
                       "Give the LPS z of the base plane, where a needle has the retraction 0, in mm");
  }
  if (!plan.goals.empty() && !plan.goal_table.empty()) {
    return input_error(place("plan.goals"),
                       fmt::format("plan.goals = \"{}\" is a table of goals, and there are {} [[plan.goal]]",
                                   plan.goals, plan.goal_table.size()),
                       "Give the goals as a file or as tables, not as both");
  }
  for (std::size_t i = 0; i < plan.needles.size(); ++i) {
    const Scenario::PlanNeedle& needle = plan.needles[i];
    const std::string name = fmt::format("plan.needle[{}]", i);
    if (needle.hole.empty() != needle.at_mm.has_value()) {
      return input_error(
          place(name), fmt::format("{} has {}", name, needle.at_mm ? "both hole and at_mm" : "neither hole nor at_mm"),
          "Say where its line is: hole = \"D4\" or at_mm = [10, 5]");
    }
    if (needle.train.empty() != !needle.seeds_mm.empty()) {
      return input_error(place(name),
                         fmt::format("{} has {}", name,
                                     needle.train.empty() ? "neither train nor seeds_mm" : "both train and seeds_mm"),
                         "Say where its seeds are: train = \"S-1-S\" or seeds_mm = [0, 10]");
    }
    if (needle.hole.empty()) continue;
    const auto offset = s.grid.offset_mm(needle.hole);
    if (!offset) {
      return input_error(place(name + ".hole"),
                         fmt::format("{}.hole = \"{}\": {}", name, needle.hole, offset.error().what),
                         offset.error().cure);
    }
    if (!s.grid.centre_mm) {
      return input_error(
          place(name + ".hole"),
          fmt::format("{}.hole = \"{}\" is a hole, and template.centre_mm, which says where holes are, is "
                      "missing",
                      name, needle.hole),
          "Give template.centre_mm, since places of a plan must not depend on a mesh; or at_mm instead of "
          "the hole");
    }
    for (std::size_t before = 0; before < i; ++before) {
      const std::string& other = plan.needles[before].hole;
      if (other.empty()) continue;
      const auto its = s.grid.offset_mm(other);
      if (!its || *its != *offset) continue;
      return input_error(
          place(name + ".hole"),
          fmt::format("{}.hole = \"{}\" is the hole of plan.needle[{}] as well", name, needle.hole, before),
          "Give all seeds of a hole to one needle");
    }
  }
  return Ok{};
}

/// Holes that the template has, each taken by one needle.
Result<> check_stabilising(const Scenario& s, const ScenarioPlace& place) {
  for (const std::string& hole : s.procedure.stabilising) {
    const auto offset = s.grid.offset_mm(hole);
    if (!offset) {
      return input_error(place("procedure.stabilising"),
                         fmt::format("procedure.stabilising names \"{}\": {}", hole, offset.error().what),
                         offset.error().cure);
    }
    for (std::size_t i = 0; i < s.insertions.size(); ++i) {
      if (!s.insertions[i].hole) continue;
      const auto own = s.grid.offset_mm(*s.insertions[i].hole);
      if (!own || *own != *offset) continue;
      return input_error(place(fmt::format("insertion[{}].hole", i)),
                         fmt::format("insertion[{}].hole = \"{}\" is taken: procedure.stabilising leaves a needle in "
                                     "this hole",
                                     i, *s.insertions[i].hole),
                         "Choose another hole, or take this one out of procedure.stabilising");
    }
  }
  return Ok{};
}

}  // namespace

Result<> check_scenario(const Scenario& s, const ScenarioPlace& place) {
  using Method = CouplingSettings::Method;
  using Engine = CouplingSettings::Engine;
  using Solver = CouplingSettings::Solver;
  if (Result<> checked = check_scenario_keys(s, place); !checked) return checked;
  if (s.patient.source.empty()) {
    return input_error(place("patient.source"), "there is no patient: patient.source is missing",
                       "Name a contour set, a mask or a mesh, or write source = \"phantom\" below [patient]");
  }
  for (const auto& [region, t] : s.tissue) {
    if (t.friction_coulomb_N_per_m > t.friction_static_N_per_m) {
      const std::string name = "tissue." + region;
      return input_error(place(name + ".friction_coulomb_N_per_m"),
                         fmt::format("{}.friction_coulomb_N_per_m = {} N/m exceeds friction_static_N_per_m = {} N/m",
                                     name, t.friction_coulomb_N_per_m, t.friction_static_N_per_m),
                         "Lower the sliding friction or raise the static friction");
    }
  }
  if (Result<> checked = check_stabilising(s, place); !checked) return checked;
  const bool several = !s.procedure.stabilising.empty() || s.procedure.together != NeedlesTogether::one;
  if (several && (s.coupling.solver != Solver::coupled || s.coupling.engine != Engine::condensed)) {
    return input_error(place("procedure.together"),
                       "several needles in one tissue need coupling.solver = \"coupled\" and coupling.engine = "
                       "\"condensed\"",
                       "Leave both out, or let the needles go in one after the other without stabilising ones");
  }
  if (s.fixed.box_mm) {
    const auto& box = *s.fixed.box_mm;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box[axis] < box[axis + 3]) continue;
      return input_error(
          place("fixed.box_mm"),
          fmt::format("fixed.box_mm: the low corner's {0} = {1} is not below the high corner's {0} = {2}", "xyz"[axis],
                      box[axis], box[axis + 3]),
          "Give the low corner x, y, z and then the high corner x, y, z");
    }
  }
  if (s.coupling.spacing_mm < s.needle.diameter_mm) {
    return input_error(place("coupling.spacing_mm"),
                       fmt::format("coupling.spacing_mm = {} is less than needle.diameter_mm = {}",
                                   s.coupling.spacing_mm, s.needle.diameter_mm),
                       "Give at least the diameter, since closer contacts cannot be told apart");
  }
  if (s.coupling.method == Method::node_repositioning && s.coupling.engine == Engine::condensed) {
    return input_error(place("coupling.method"),
                       "coupling.method = \"node-repositioning\" changes the stiffness of all elements around the node "
                       "that moves, and coupling.engine = \"condensed\" never changes the stiffness of the mesh",
                       "Choose engine = \"woodbury\" or \"bcs\", or method = \"node-addition\"");
  }
  if (s.tissue_model.element == ElementChoice::nodal_pressure || s.tissue_model.element == ElementChoice::p2) {
    const auto refused = [&](const std::string& setting, const char* cure) {
      return input_error(place("tissue.element"),
                         fmt::format("{} needs linear tetrahedra, and tissue.element = \"{}\" is another element",
                                     setting, word(s.tissue_model.element)),
                         cure);
    };
    if (s.coupling.method == Method::node_addition || s.coupling.method == Method::node_repositioning) {
      return refused(fmt::format("coupling.method = \"{}\"", word(s.coupling.method)),
                     "Set tissue.element = \"p1\", or coupling.method = \"near-field\" or \"embedded\"");
    }
    if (s.coupling.engine != Engine::condensed) {
      return refused(fmt::format("coupling.engine = \"{}\"", word(s.coupling.engine)),
                     "Set tissue.element = \"p1\", or coupling.engine = \"condensed\"");
    }
  }
  if (s.coupling.damping != Scenario{}.coupling.damping && s.coupling.solver != Solver::staggered) {
    return input_error(place("coupling.damping"),
                       "coupling.damping belongs to coupling.solver = \"staggered\", and the solver is \"coupled\"",
                       "Set solver = \"staggered\", or leave damping out");
  }
  if (s.coupling.projection == Projection::nearest_node && s.coupling.solver != Solver::staggered) {
    return input_error(
        place("coupling.projection"),
        "coupling.projection = \"nearest-node\" belongs to coupling.solver = \"staggered\", and the solver "
        "is \"coupled\"",
        "Set solver = \"staggered\", or leave projection = \"exact\"");
  }
  if (Result<> checked = check_plan(s, place); !checked) return checked;
  if (s.insertions.empty() && !s.plan.is_given()) {
    return input_error(place(""), "there is no needle: no [[insertion]]",
                       "Add [[insertion]] and below it, for example, hole = \"D4\"");
  }
  for (std::size_t i = 0; i < s.insertions.size(); ++i) {
    if (Result<> checked = check_insertion(s, i, place); !checked) return checked;
  }
  return Ok{};
}

Result<> check_has_insertion(const Scenario& scenario, const std::string& where) {
  if (!scenario.insertions.empty()) return Ok{};
  return input_error(
      where, "the scenario has a plan of seeds, but no needle to insert: no [[insertion]]",
      "Carry out its plan with stylet implant, or add [[insertion]] and below it, for example, hole = \"D4\"");
}

Result<> check_scenario(const Scenario& scenario, const std::string& where) {
  return check_scenario(scenario, [&](const std::string&) { return where; });
}

}  // namespace stylet
