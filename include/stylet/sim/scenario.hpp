// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/geom/soft_layers.hpp"
#include "stylet/sim/choices.hpp"
#include "stylet/sim/imaging_settings.hpp"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// Parameters of a tissue, of its interaction with a needle and of its pictures. Every default has a source: see
/// default_tissue().
struct TissueParameters {
  double young_kPa = 0;
  double poisson = 0;
  double cutting_N = 0;   ///< axial force at which the tip begins to cut; coupling.tip_viscosity_Ns_per_m adds to it
  double puncture_N = 0;  ///< axial force at which the tip breaks the region's surface; 0 = no membrane
  double stiffening = 0;  ///< k₂/E, without unit, of the dent under the tip, F = k₁ z + k₂ z²
                          ///< (docs/theory/stiffening.md); 0 = linear tissue
  // Friction between shaft and tissue per inserted length, see FrictionLaw.
  double friction_static_N_per_m = 0;
  double friction_coulomb_N_per_m = 0;
  double friction_viscous_Ns_per_m2 = 0;
  double friction_viscous_to_mm_per_s = 50;  ///< speed beyond which sliding friction stays constant
  std::string source;                        ///< where the values come from
  TissueEcho echo;                           ///< of pictures, not of the mechanics

  bool operator==(const TissueParameters&) const = default;
};

/// Default parameters for a region by its canonical name ("prostate", "body", "label_2", …): published values or, if
/// there are none, fitted or assumed values; TissueParameters::source says which. Unknown names get the values of the
/// soft tissue around the gland.
TissueParameters default_tissue(const std::string& region, TissuePreset preset = TissuePreset::typical);

/// Names of the regions for which default_tissue() has its own values, in the order of the documentation.
std::vector<std::string> known_tissues();

/// Whether a region fills the space between the organs (fat, muscle, the body). Such regions have no membrane between
/// them: the only membrane at their surface is the skin.
bool is_surrounding(const std::string& region);

/// A guide template: a grid of holes in front of the perineum. Columns are lettered A a B b … G from the patient's
/// right to the left, rows numbered 1, 1.5, … 7 from posterior to anterior.
struct TemplateGrid {
  double pitch_mm = 5.0;
  std::optional<std::array<double, 2>> centre_mm;  ///< LPS x and y of hole D4; unset: x and y of the target's centroid
  std::vector<std::string> columns{"A", "a", "B", "b", "C", "c", "D", "d", "E", "e", "F", "f", "G"};
  std::vector<std::string> rows{"1", "1.5", "2", "2.5", "3", "3.5", "4", "4.5", "5", "5.5", "6", "6.5", "7"};

  /// Offset of a hole from the grid's centre [mm]: (towards the patient's left, towards anterior). Accepts "D4",
  /// "d3.5".
  [[nodiscard]] Result<std::array<double, 2>> offset_mm(const std::string& hole) const;

  bool guide = false;          ///< the hole holds the shaft sideways
  double clearance_mm = 0.05;  ///< radius of the hole minus radius of the needle
  double distance_mm = 10.0;   ///< distance between template and skin, along the needle

  bool operator==(const TemplateGrid&) const = default;
};

/// One needle going in and out.
struct InsertionPlan {
  std::optional<std::string> hole;                 ///< template hole; either this or entry_mm is needed
  std::optional<std::array<double, 3>> entry_mm;   ///< a point on the needle's line, LPS
  std::optional<std::array<double, 3>> direction;  ///< LPS, need not be a unit vector; default superior
  std::optional<std::array<double, 3>> target_mm;  ///< a point at which the needle aims, LPS, instead of a direction
  double roll_deg = 0.0;                           ///< rotation of the needle about its axis, from local x to local y
  double approach_mm = 3.0;                        ///< free travel before the skin
  double depth_mm = 0.0;  ///< largest base depth, from skin contact; 0 = to the far end of the target
  double speed_mm_per_s = 20.0;
  double dwell_s = 0.3;
  double retract_speed_mm_per_s = 20.0;
  bool retract = true;  ///< draw the needle out after the dwell
  std::string motion;   ///< file of a recorded base motion (CSV), which replaces all keys above

  bool operator==(const InsertionPlan&) const = default;
};

/// Description of a simulation: patient, tissue, supports, mesh, needle, coupling, insertions, output. Every field is a
/// key of the scenario file, whose name contains the unit; docs/scenario.md explains each key.
struct Scenario {
  std::string name = "insertion";
  struct Patient {
    std::string source;                          ///< contours, mask or mesh; relative to the scenario file
    std::map<std::string, std::string> regions;  ///< ROI name or label → region name
    std::vector<std::string> skip;               ///< structures or labels to leave out
    double scale = 0.0;                          ///< [mm] length of the unit of a mesh file; 0 = as the file says
    int volume = 0;                              ///< number of the volume in a mask file, from 1; 0 = the only one
    std::string regions_from;                    ///< array of a mesh file that is its regions; empty = as the file says
    bool operator==(const Patient&) const = default;
  } patient;
  struct TissueModel {
    TissuePreset preset = TissuePreset::typical;  ///< source of the values of regions without an override
    ElementChoice element = ElementChoice::automatic;
    std::optional<double> creep;  ///< ratio of final to immediate displacement under a constant force; see creep_of()
    double creep_s = 0.6;         ///< time constant of the creep under a constant force
    bool operator==(const TissueModel&) const = default;
  } tissue_model;                                  ///< for all regions: the keys of [tissue] itself
  std::map<std::string, TissueParameters> tissue;  ///< overrides, complete (defaults filled in)
  struct Fixed {
    std::vector<std::string> regions;              ///< regions held whole; empty = pubic arch and femurs, if present
    OuterSupport outer = OuterSupport::automatic;  ///< outer faces that are held; sides = all but the perineal face
    std::optional<std::array<double, 6>> box_mm;   ///< LPS, low and high corner: nodes inside are held as well
    bool operator==(const Fixed&) const = default;
  } fixed;
  SoftLayers anatomy = typical_layers();  ///< layers of the patient that contours and masks do not show
  struct Mesh {
    int nodes = 0;  ///< 0 = the preset's default
    MeshPreset preset = MeshPreset::standard;
    double cull_mm = 0.3;
    bool stiff_band = true;
    bool operator==(const Mesh&) const = default;
  } mesh;
  struct NeedleChoice {
    NeedleModel model = NeedleModel::beam;
    double length_mm = 200.0;
    double diameter_mm = 1.27;
    std::optional<double> lumen_diameter_mm;  ///< unset: same ratio to the outer diameter as an 18 gauge needle
    double young_GPa = 200.0;
    StyletPlace stylet = StyletPlace::out;
    std::optional<double> stylet_diameter_mm;  ///< unset: 0.9 times the lumen's diameter
    double stylet_young_GPa = 200.0;
    std::optional<double> bending_stiffness_Nmm2;  ///< unset: computed from the section
    std::optional<double> torsion_stiffness_Nmm2;  ///< unset: computed from the section
    double bevel_deg = 0.0;                        ///< angle between the bevel's face and the axis; 0 = symmetric tip
    Bevel::Law bevel_law = Bevel::Law::offset;
    double bevel_force_ratio = 0.06;
    double bow_mm = 0.0;   ///< offset of the unloaded needle's tip from its axis
    double bow_deg = 0.0;  ///< direction of the offset, about the axis
    int elements = 0;      ///< 0 = the default of the needle model
    bool operator==(const NeedleChoice&) const = default;
  } needle;
  /// Interaction of needle and tissue; CouplingSettings explains these values.
  struct Coupling {
    CouplingSettings::Method method = CouplingSettings::Method::near_field;
    CouplingSettings::Rule rule = CouplingSettings::Rule::interior;
    CouplingSettings::Solver solver = CouplingSettings::Solver::coupled;
    CouplingSettings::Engine engine = CouplingSettings::Engine::condensed;
    double damping = 1.0;
    Projection projection = Projection::exact;
    double spacing_mm = 4.0;
    double tip_viscosity_Ns_per_m = 2.0;
    double bone_damping_ms = 3.0;
    double grazing_deg = 80.0;
    double corridor_mm = 8.0;
    int corridor_nodes = 3500;
    int spare_nodes = 1500;
    int contacts = 96;
    double tolerance = 1e-8;
    bool operator==(const Coupling&) const = default;
  } coupling;
  TemplateGrid grid;
  std::vector<InsertionPlan> insertions;
  /// A needle of a plan that is written in the scenario, with its train of permanent seeds.
  struct PlanNeedle {
    std::string hole;                            ///< template hole; either this or at_mm is needed
    std::optional<std::array<double, 2>> at_mm;  ///< LPS x and y of the needle's line, which is along z
    double retraction_mm = 0.0;                  ///< distance of the retraction plane inferior of ImplantPlan::base_mm
    std::string train;  ///< seeds and spacers from the tip on, such as "S-1-S"; either this or seeds_mm is needed
    std::vector<double> seeds_mm;      ///< distances of the seeds' centres inferior of the retraction plane
    std::optional<double> strength_U;  ///< unset: that of the plan
    std::optional<bool> stranded;      ///< unset: Seed::stranded
    bool operator==(const PlanNeedle&) const = default;
  };
  /// A goal of a plan that is written in the scenario: a DoseGoal with its bound as text.
  struct PlanGoal {
    std::string structure, metric, bound, citation;
    bool operator==(const PlanGoal&) const = default;
  };
  /// The plan of an implant, for `stylet implant`: a file or a list of needles; with neither the scenario has none.
  struct ImplantPlan {
    std::string file;    ///< DICOM RTPLAN, JSON or CSV; relative to the scenario file
    std::string source;  ///< source model, or the file of one; empty: the plan names it
    std::string goals;   ///< file with a table of goals; empty: goal_table, or those of the program
    // Of a plan that is written in the scenario.
    std::string label;
    double strength_U = 0.0;        ///< air-kerma strength of a seed; 0: each needle has its own
    double prescription_Gy = 0.0;   ///< prescribed dose; 0: none
    std::optional<double> base_mm;  ///< LPS z of the base plane, where the retraction is 0
    double seed_length_mm = 4.5;    ///< in a train
    double spacer_length_mm = 5.5;  ///< in a train
    std::vector<PlanNeedle> needles;
    std::vector<PlanGoal> goal_table;

    /// Whether the scenario has a plan.
    [[nodiscard]] bool is_given() const { return !file.empty() || !needles.empty(); }
    bool operator==(const ImplantPlan&) const = default;
  } plan;
  /// How the needles of the plan go in and out.
  struct Procedure {
    SeedTechnique technique = SeedTechnique::preloaded;
    NeedleOrder order = NeedleOrder::plan;
    NeedlesTogether together = NeedlesTogether::one;
    std::vector<std::string> stabilising;  ///< template holes
    double speed_mm_per_s = 20.0;
    double pause_s = 2.0;
    double drop_speed_mm_per_s = 5.0;
    double retract_speed_mm_per_s = 20.0;
    double plug_mm = 0.0;
    double catheter_tip_mm = 6.0;  ///< temporary implants: tip to the centre of the most distal dwell position
    double planning_to_delivery_s = 3600.0;  ///< temporary implants: from the images of the plan to the dose
    bool operator==(const Procedure&) const = default;
  } procedure;
  /// The fate of a seed beside the motion of the tissue.
  struct Seed {
    bool stranded = false;
    double release_mm = 0.0;
    double release_sd_mm = 0.0;
    double loss_percent = 0.0;
    int random = 1;
    bool operator==(const Seed&) const = default;
  } seed;
  /// Swelling of the gland after the implantation.
  struct Oedema {
    std::array<double, 3> swelling_percent{0.0, 0.0, 0.0};
    double half_life_days = 9.3;
    bool operator==(const Oedema&) const = default;
  } oedema;
  ProbeSettings probe;
  UltrasoundSettings ultrasound;
  FluoroscopySettings fluoroscopy;
  struct Run {
    double dt_ms = 1.0;
    bool operator==(const Run&) const = default;
  } run;
  struct Output {
    double frames_per_s = 8.0;
    int max_frames = 80;
    bool pictures = true;
    bool operator==(const Output&) const = default;
  } output;

  bool operator==(const Scenario&) const = default;
};

/// The tissue parameters of a region in a scenario: the scenario's override, or the preset's default.
TissueParameters tissue_of(const Scenario& scenario, const std::string& region);

/// Creep of the scenario's tissue: ratio of the final to the immediate displacement under a constant force; 1 =
/// elastic.
double creep_of(const Scenario& scenario);

/// A value of a scenario file.
struct ScenarioValue {
  enum class Type { number, integer, boolean, text, numbers, texts };
  Type type = Type::number;
  double number = 0;
  bool boolean = false;
  std::string text{};
  std::vector<double> numbers{};
  std::vector<std::string> texts{};
};

/// The value as text of a scenario file: 60, true, "D4", [0, 0, 1].
std::string to_string(const ScenarioValue& value);

/// Documentation of a key of the scenario.
struct ScenarioKey {
  std::string path;  ///< "tissue.<region>.young_kPa", "patient.regions.<name>", "insertion[].hole", "mesh.nodes"
  ScenarioValue::Type type = ScenarioValue::Type::number;
  std::string unit;      ///< "mm"; empty for a pure number or a word
  std::string standard;  ///< default: a value as in a file, or words such as "by region"
  std::string range;     ///< allowed values as text: "20 … 1000", "\"sides\", \"all\""
  std::string meaning;
  std::string example;  ///< a value as in a file; the default, if it is a value
};

/// All keys, in the order of the documentation.
const std::vector<ScenarioKey>& scenario_keys();

/// Sets one key. Errors: an unknown key (the message suggests the nearest known name); a value out of range or of the
/// wrong type (the message gives the allowed range). On error the scenario is unchanged.
/// @param path "tissue.prostate.young_kPa", "insertion[0].hole", "mesh.nodes"
/// @param where file and line for the message
Result<> set_scenario_key(Scenario& scenario, const std::string& path, const ScenarioValue& value,
                          const std::string& where);

/// The value of one key; empty if the key is not set (its default depends on the patient) or does not exist.
/// @param path as for set_scenario_key()
std::optional<ScenarioValue> scenario_value(const Scenario& scenario, const std::string& path);

/// Function that names the place of a key for messages, e.g. "demo.toml, line 12". Its argument is a path such as
/// "insertion[0].hole" or, if no single key is at fault, "insertion[0]" or "".
using ScenarioPlace = std::function<std::string(const std::string& path)>;

/// Checks that set_scenario_key() would accept the value of every key of a scenario, and returns its error otherwise.
/// Thus fields that were set in C++ obey the same table of ranges as files.
Result<> check_scenario_keys(const Scenario& scenario, const ScenarioPlace& place);

/// Checks a scenario: every key by check_scenario_keys(), then the rules that concern several keys, such as at least
/// one insertion, one way to give its entry, a depth within the needle's length, and keys that exclude each other.
Result<> check_scenario(const Scenario& scenario, const ScenarioPlace& place);
/// @param where name of the scenario in messages
Result<> check_scenario(const Scenario& scenario, const std::string& where);

/// Checks that a scenario has an insertion; one with a plan of seeds need not. @param where as above
Result<> check_has_insertion(const Scenario& scenario, const std::string& where);

}  // namespace stylet
