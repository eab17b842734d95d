// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// What a tissue is made of and what it does to a needle. Every number has a source: see default_tissue().
struct TissueParameters {
  double young_kPa = 0;
  double poisson = 0;
  double cutting_N = 0;
  double puncture_N = 0;  ///< of the surface around it; 0 = no membrane
  double friction_static_N_per_m = 0;
  double friction_coulomb_N_per_m = 0;
  double friction_viscous_Ns_per_m2 = 0;
  std::string source;  ///< where the values come from
};

/// Published or, where nothing is published, stated defaults for a region by its canonical name ("prostate", "body",
/// "label_2", …). Unknown names get the values of soft tissue around the gland.
TissueParameters default_tissue(const std::string& region);

/// A guide template: a grid of holes in front of the perineum. Columns are lettered A a B b … G from the patient's
/// right to the left, rows numbered 1, 1.5, … 7 from posterior to anterior.
struct TemplateGrid {
  double pitch_mm = 5.0;
  std::optional<std::array<double, 2>> centre_mm;  ///< LPS x and y of hole D4; unset: the target's centroid
  std::vector<std::string> columns{"A", "a", "B", "b", "C", "c", "D", "d", "E", "e", "F", "f", "G"};
  std::vector<std::string> rows{"1", "1.5", "2", "2.5", "3", "3.5", "4", "4.5", "5", "5.5", "6", "6.5", "7"};

  /// Offset of a hole from the grid's centre [mm]: (towards the patient's left, towards anterior). Accepts "D4",
  /// "d3.5".
  [[nodiscard]] Result<std::array<double, 2>> offset_mm(const std::string& hole) const;
};

/// One needle going in and out.
struct InsertionPlan {
  std::optional<std::string> hole;                 ///< template hole, or
  std::optional<std::array<double, 3>> entry_mm;   ///< a point the needle passes before the skin, LPS
  std::optional<std::array<double, 3>> direction;  ///< LPS, need not be a unit vector; default superior
  std::optional<std::array<double, 3>> target_mm;  ///< a point to aim at, LPS, instead of a direction
  double approach_mm = 3.0;                        ///< free travel before the skin
  double depth_mm = 0.0;  ///< of the base beyond skin contact; 0 = to the far end of the target
  double speed_mm_per_s = 20.0;
  double dwell_s = 0.3;
  double retract_speed_mm_per_s = 20.0;
  bool retract = true;  ///< pull the needle out after the dwell
  std::string motion;   ///< a recorded base motion (CSV) instead of all the above
};

/// A simulation, as a person writes it down. Every field is a key of the scenario file with its unit in the name.
struct Scenario {
  std::string name = "insertion";
  struct Patient {
    std::string source;                          ///< contours, mask or mesh; relative to the scenario file
    std::map<std::string, std::string> regions;  ///< ROI name or label → region name
    double scale = 0.0;                          ///< [mm] unit of a mesh file; 0 = as the file says
  } patient;
  std::map<std::string, TissueParameters> tissue;  ///< overrides, complete (defaults filled in)
  struct Fixed {
    std::vector<std::string> regions;  ///< regions whose nodes are all held; empty = pubic arch and femurs if there
    std::string outer = "auto";        ///< auto, none, all, sides (all but the perineal face)
    std::optional<std::array<double, 6>> box_mm;  ///< LPS, low and high corner: nodes inside are held as well
  } fixed;
  struct Mesh {
    int nodes = 0;  ///< 0 = the preset's default
    std::string preset = "standard";
    double cull_mm = 0.3;
    bool stiff_band = true;
  } mesh;
  struct NeedleChoice {
    std::string model = "beam";
    double length_mm = 200.0;
    double diameter_mm = 1.27;
    double bending_stiffness_Nmm2 = 15700.0;
    double torsion_stiffness_Nmm2 = 12100.0;
    int elements = 24;
  } needle;
  struct Coupling {
    std::string method = "node-addition";
    std::string rule = "interior";
    std::string solver = "coupled";
    std::string engine = "condensed";
    double spacing_mm = 4.0;
    double tip_viscosity_Ns_per_m = 2.0;
    double grazing_deg = 80.0;
    double corridor_mm = 8.0;
    int contacts = 96;
  } coupling;
  TemplateGrid grid;
  std::vector<InsertionPlan> insertions;
  struct Run {
    double dt_ms = 1.0;
  } run;
  struct Output {
    double frames_per_s = 8.0;
    int max_frames = 80;
    bool pictures = true;
  } output;
};

/// A value as it stands in a scenario file.
struct ScenarioValue {
  enum class Type { number, integer, boolean, text, numbers, texts };
  Type type = Type::number;
  double number = 0;
  bool boolean = false;
  std::string text;
  std::vector<double> numbers;
  std::vector<std::string> texts;
};

/// What is known about a key.
struct ScenarioKey {
  std::string path;  ///< "tissue.<region>.young_kPa", "insertion[].hole", "mesh.nodes"
  ScenarioValue::Type type;
  std::string unit;
  std::string standard;  ///< default, as text
  std::string range;     ///< as text
  std::string meaning;
};

/// All keys, in the order of documentation.
const std::vector<ScenarioKey>& scenario_keys();

/// Sets one key. Unknown keys are refused with the nearest known name; values out of range or of the wrong type with
/// the documented range.
/// @param path "tissue.prostate.young_kPa", "insertion[0].hole", "mesh.nodes"
/// @param where file and line for the message
Result<> set_scenario_key(Scenario& scenario, const std::string& path, const ScenarioValue& value,
                          const std::string& where);

/// What single keys cannot show: at least one insertion, entry given one way, depth within the needle, methods that
/// exist.
Result<> check_scenario(const Scenario& scenario, const std::string& where);

}  // namespace stylet
