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
  if (s.insertions.empty() && s.plan.file.empty()) {
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
