// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_choice.hpp"
#include "stylet/core/version.hpp"
#include "stylet/needle/make_needle.hpp"
#include "stylet/needle/tet.hpp"
#include "stylet/sim/model.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

/// The description of a model for a report: every parameter with its value and the source of the value.
namespace stylet {

namespace {

constexpr const char* kFromScenario = "scenario";
constexpr const char* kFromProgram = "a part of the program that made the model";
constexpr std::string_view kElements = "needle.elements";

/// A key whose value a report shows, and the reason for its default.
struct Shown {
  const char* path;
  const char* source;
};

/// Reports show only these keys, besides the tissue, the needle's section and the guide.
constexpr std::array kShown{
    Shown{"needle.model", "most accurate for its cost"},
    Shown{"needle.length_mm", "usual brachytherapy needle, 150-200 mm"},
    Shown{"needle.diameter_mm", "18 gauge"},
    Shown{"needle.stylet", "seeds and spacers are in its place"},
    Shown{"needle.bevel_deg", "stated: a symmetric tip"},
    Shown{"needle.bevel_law", "reproduces measured deflections with one number that can be measured on the needle"},
    Shown{"needle.bevel_force_ratio", "0.04-0.08 measured (Okamura 2004); for the law force only"},
    Shown{"needle.bow_mm", "a straight needle"},
    Shown{"needle.bow_deg", "a straight needle has no side"},
    Shown{kElements.data(), "numerical: no visible change of the needle's shape with more"},
    Shown{"coupling.method", "force does not depend on the mesh"},
    Shown{"coupling.rule", "existing compliances do not change when a node is added"},
    Shown{"coupling.engine", "cost does not depend on the size of the mesh"},
    Shown{"coupling.solver", "needs no damping parameter"},
    Shown{"coupling.spacing_mm", "numerical: about three needle diameters"},
    Shown{"coupling.tip_viscosity_Ns_per_m",
          "numerical: when a membrane breaks, the tip advances within milliseconds instead of at once"},
    Shown{"coupling.bone_damping_ms", "numerical: a needle that snaps on bone takes milliseconds to do so"},
    Shown{"coupling.grazing_deg", "stated, no measurement known"},
    Shown{"coupling.tolerance", "numerical: results do not depend on it"},
    Shown{"run.dt_ms", "update rate of haptic devices, 1 kHz"},
};

/// Layers that are added to the patient if the input does not have them.
struct ShownLayer {
  const char* path;
  const char* region;
};
constexpr std::array kShownLayers{
    ShownLayer{"anatomy.periprostatic_fat_mm", "periprostatic_fat"},
    ShownLayer{"anatomy.levator_mm", "levator"},
    ShownLayer{"anatomy.ischiorectal_fat_mm", "ischiorectal_fat"},
    ShownLayer{"anatomy.subcutaneous_fat_mm", "subcutaneous_fat"},
    ShownLayer{"anatomy.rectal_wall_mm", "rectal_lumen"},
};

std::string as_shown(const ScenarioValue& value) {
  return value.type == ScenarioValue::Type::text ? value.text : to_string(value);
}

std::string unit_of(const std::string& path) {
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.path == path) return key.unit;
  }
  return {};
}

/// Adds the rows of a region, or a single row if the region is held.
void add_tissue(std::vector<ParameterRow>& rows, const std::string& region, TissuePreset preset,
                const TissueParameters& used, bool held) {
  if (held) {
    rows.push_back({"tissue." + region, "held", "", "bone, or a region that the scenario holds"});
    return;
  }
  const TissueParameters standard = default_tissue(region, preset);
  const auto row = [&](const char* key, double TissueParameters::*field, const char* unit) {
    rows.push_back({"tissue." + region + "." + key, fmt::format("{:g}", used.*field), unit,
                    used.*field == standard.*field ? standard.source : kFromScenario});
  };
  row("young_kPa", &TissueParameters::young_kPa, "kPa");
  row("poisson", &TissueParameters::poisson, "");
  row("cutting_N", &TissueParameters::cutting_N, "N");
  row("puncture_N", &TissueParameters::puncture_N, "N");
  row("stiffening", &TissueParameters::stiffening, "");
  row("friction_static_N_per_m", &TissueParameters::friction_static_N_per_m, "N/m");
  row("friction_coulomb_N_per_m", &TissueParameters::friction_coulomb_N_per_m, "N/m");
  row("friction_viscous_Ns_per_m2", &TissueParameters::friction_viscous_Ns_per_m2, "N s/m²");
  row("friction_viscous_to_mm_per_s", &TissueParameters::friction_viscous_to_mm_per_s, "mm/s");
}

/// Adds the needle's stiffness, given by the scenario or computed from the section.
void add_section(std::vector<ParameterRow>& rows, const Scenario::NeedleChoice& choice) {
  const auto section = needle_section(choice);
  if (!section) return;  // cannot happen: compile() has checked the section
  const Cannula tube = cannula_of(choice);
  std::string from = fmt::format("tube of {:.3g} mm outer and {:.3g} mm inner diameter, E {:g} GPa", choice.diameter_mm,
                                 tube.lumen_diameter_mm, choice.young_GPa);
  rows.push_back({"needle.torsion_stiffness_Nmm2", fmt::format("{:.0f}", section->torsion_stiffness_Nmm2), "N mm²",
                  choice.torsion_stiffness_Nmm2 ? kFromScenario : from});
  if (tube.stylet_diameter_mm > 0.0)
    from += fmt::format(", stylet of {:.3g} mm, E {:g} GPa", tube.stylet_diameter_mm, choice.stylet_young_GPa);
  rows.push_back({"needle.bending_stiffness_Nmm2", fmt::format("{:.0f}", section->bending_stiffness_Nmm2), "N mm²",
                  choice.bending_stiffness_Nmm2 ? kFromScenario : from});
}

void add_guide(std::vector<ParameterRow>& rows, const TemplateGrid& grid) {
  const TemplateGrid standard;
  const auto source = [](bool is_default) { return is_default ? "stated, no measurement known" : kFromScenario; };
  rows.push_back({"template.guide", "true", "", kFromScenario});
  rows.push_back({"template.clearance_mm", fmt::format("{:g}", grid.clearance_mm), "mm",
                  source(grid.clearance_mm == standard.clearance_mm)});
  rows.push_back({"template.distance_mm", fmt::format("{:g}", grid.distance_mm), "mm",
                  source(grid.distance_mm == standard.distance_mm)});
}

/// Adds the numbers that the tetrahedral needle model calibrates itself.
void add_tet(std::vector<ParameterRow>& rows, const Scenario::NeedleChoice& choice) {
  const auto section = needle_section(choice);
  if (!section) return;  // cannot happen: compile() has checked the section
  const int segments = choice.elements > 0 ? choice.elements : default_needle_elements(word(choice.model)).value();
  const auto built = TetNeedle::build(*section, segments, 1);
  if (!built) return;
  const TetNeedle* tet = built->get();
  rows.push_back({"needle.tet.calibration", fmt::format("{:.4g}", 1.0 / tet->stiffening()), "",
                  "factor on Young's modulus with which the tip deflects as in beam theory; linear tetrahedra are too "
                  "stiff in bending"});
  rows.push_back({"needle.tet.axial_stiffness", fmt::format("{:.4g}", tet->axial_stiffness()), "N/mm",
                  "follows from the calibrated modulus"});
}

}  // namespace

RunInfo Model::info(std::size_t insertion) const {
  RunInfo info;
  info.version = version();
  info.scenario_name = scenario_.name;
  const Scenario::Coupling& coupling = scenario_.coupling;
  info.method = word(coupling.method);
  if (coupling.method == CouplingSettings::Method::node_addition) info.method += ", " + word(coupling.rule) + " rule";
  if (coupling.engine != CouplingSettings::Engine::condensed) info.method += ", engine " + word(coupling.engine);
  if (coupling.solver != CouplingSettings::Solver::coupled) info.method += ", " + word(coupling.solver);
  info.needle_diameter_mm = scenario_.needle.diameter_mm;
  info.needle_length_mm = scenario_.needle.length_mm;
  info.target_regions = regions_.target;
  info.supports = supports_.description;
  if (!staying().empty()) {
    info.supports.push_back(
        fmt::format("Needles are in place in the {} {} (procedure.stabilising). They went in before, their hubs are "
                    "locked, and they hold the tissue by friction.",
                    staying().size() == 1 ? "hole" : "holes", fmt::join(scenario_.procedure.stabilising, ", ")));
  }
  info.warnings = warnings_;
  if (insertion < insertions().size()) {
    info.entry_mm = insertions()[insertion].entry;
    info.direction = insertions()[insertion].direction;
  }
  for (std::size_t r = 0; r < mesh().regions.size(); ++r)
    add_tissue(info.parameters, mesh().regions[r], scenario_.tissue_model.preset, regions_.parameters[r],
               regions_.laws[r].rigid);
  info.parameters.push_back({"tissue.element", to_string(built_.tissue->element()), "",
                             scenario_.tissue_model.element == ElementChoice::automatic
                                 ? "depends on coupling.method: linear tetrahedra if the method needs them or for "
                                   "comparison, else an element without locking"
                                 : kFromScenario});
  const Scenario standard;
  const Scenario::TissueModel& tissue = scenario_.tissue_model;
  info.parameters.push_back({"tissue.preset", word(tissue.preset), "",
                             tissue.preset == standard.tissue_model.preset ? "default" : kFromScenario});
  const double creep = creep_of(scenario_);
  info.parameters.push_back(
      {"tissue.creep", fmt::format("{:g}", creep), "",
       tissue.creep ? kFromScenario
                    : (creep > 1.0 ? "fitted: the gland moves less when the needle is faster" : "stated: elastic")});
  if (creep > 1.0) {
    info.parameters.push_back({"tissue.creep_s", fmt::format("{:g}", tissue.creep_s), "s",
                               tissue.creep_s == standard.tissue_model.creep_s
                                   ? "fitted: the gland moves less when the needle is faster"
                                   : kFromScenario});
  }
  for (const ShownLayer& layer : kShownLayers) {
    if (mesh().region_index(layer.region) < 0) continue;
    const std::string value = as_shown(*scenario_value(scenario_, layer.path));
    info.parameters.push_back({layer.path, value, "mm",
                               value == as_shown(*scenario_value(standard, layer.path))
                                   ? "adult anatomy (docs/meshing.md); no effect where the input has the structure"
                                   : kFromScenario});
  }
  for (const Shown& shown : kShown) {
    const auto value = scenario_value(scenario_, shown.path);
    if (!value) continue;
    std::string text = as_shown(*value);
    const bool is_default = text == as_shown(*scenario_value(standard, shown.path));
    if (own_.needle && shown.path == std::string_view("needle.model")) {
      info.parameters.push_back({shown.path, make_needle()->model(), "", kFromProgram});
      continue;
    }
    if (own_.needle && shown.path == kElements) continue;
    if (shown.path == kElements && scenario_.needle.elements == 0)
      text = std::to_string(default_needle_elements(word(scenario_.needle.model)).value());
    info.parameters.push_back({shown.path, text, unit_of(shown.path), is_default ? shown.source : kFromScenario});
  }
  if (scenario_.grid.guide) add_guide(info.parameters, scenario_.grid);
  add_section(info.parameters, scenario_.needle);
  if (own_.cutting) info.parameters.push_back({"law of cutting", own_.cutting->name(), "", kFromProgram});
  if (scenario_.needle.model == NeedleModel::tet && !own_.needle) add_tet(info.parameters, scenario_.needle);
  return info;
}

}  // namespace stylet
