// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/scenario.hpp"

#include "stylet/core/nearest_name.hpp"

#include <cmath>
#include <functional>

/// The scenario's keys as one table: path, meaning, unit, default, range, and where the value goes.
namespace stylet {

namespace {

/// What fills the wildcards of a path: "tissue.<region>.…", "patient.regions.<name>", "insertion[i].…".
struct Slot {
  std::string name;
  std::size_t index = 0;
};

using Type = ScenarioValue::Type;

struct Entry {
  ScenarioKey key;
  /// Stores the value; a text says why it cannot.
  std::function<std::string(Scenario&, const Slot&, const ScenarioValue&)> store;
};

std::string number_text(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

InsertionPlan& plan(Scenario& s, const Slot& slot) {
  if (s.insertions.size() <= slot.index) s.insertions.resize(slot.index + 1);
  return s.insertions[slot.index];
}

TissueParameters& tissue(Scenario& s, const Slot& slot) {
  return s.tissue.try_emplace(slot.name, default_tissue(slot.name)).first->second;
}

class Table {
 public:
  Table();
  std::vector<Entry> entries;

 private:
  template <class Access>
  void number(const char* path, const char* unit, const std::string& standard, double low, double high,
              const char* meaning, Access access) {
    entries.push_back({{path, Type::number, unit, standard, number_text(low) + " … " + number_text(high), meaning},
                       [=](Scenario& s, const Slot& slot, const ScenarioValue& v) -> std::string {
                         if (!(v.number >= low && v.number <= high)) return "outside its range";
                         access(s, slot) = v.number;
                         return {};
                       }});
  }
  template <class Access>
  void integer(const char* path, const char* standard, int low, int high, const char* meaning, Access access) {
    entries.push_back({{path, Type::integer, "", standard, std::to_string(low) + " … " + std::to_string(high), meaning},
                       [=](Scenario& s, const Slot& slot, const ScenarioValue& v) -> std::string {
                         if (v.number != std::floor(v.number)) return "not a whole number";
                         if (!(v.number >= low && v.number <= high)) return "outside its range";
                         access(s, slot) = static_cast<int>(v.number);
                         return {};
                       }});
  }
  template <class Access>
  void boolean(const char* path, const char* standard, const char* meaning, Access access) {
    entries.push_back({{path, Type::boolean, "", standard, "true, false", meaning},
                       [=](Scenario& s, const Slot& slot, const ScenarioValue& v) -> std::string {
                         access(s, slot) = v.boolean;
                         return {};
                       }});
  }
  template <class Access>
  void text(const char* path, const char* standard, const char* meaning, Access access) {
    entries.push_back({{path, Type::text, "", standard, "text", meaning},
                       [=](Scenario& s, const Slot& slot, const ScenarioValue& v) -> std::string {
                         access(s, slot) = v.text;
                         return {};
                       }});
  }
  /// `later` are values the name is reserved for that this version does not have.
  template <class Access>
  void choice(const char* path, const char* standard, std::vector<std::string> values, std::vector<std::string> later,
              const char* meaning, Access access) {
    std::string range;
    for (const auto& value : values) range += (range.empty() ? "\"" : ", \"") + value + "\"";
    entries.push_back({{path, Type::text, "", standard, range, meaning},
                       [=](Scenario& s, const Slot& slot, const ScenarioValue& v) -> std::string {
                         for (const auto& value : later) {
                           if (v.text == value) return "not available in this version";
                         }
                         bool known = false;
                         for (const auto& value : values) known = known || v.text == value;
                         if (!known) {
                           const std::string near = nearest_name(v.text, values);
                           return "not one of its values" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)");
                         }
                         access(s, slot) = v.text;
                         return {};
                       }});
  }
  template <std::size_t n, class Access>
  void vector(const char* path, const char* unit, const char* standard, double low, double high, const char* meaning,
              Access access) {
    entries.push_back({{path, Type::numbers, unit, standard,
                        std::to_string(n) + " numbers, each " + number_text(low) + " … " + number_text(high), meaning},
                       [=](Scenario& s, const Slot& slot, const ScenarioValue& v) -> std::string {
                         if (v.numbers.size() != n) return "has " + std::to_string(v.numbers.size()) + " numbers";
                         std::array<double, n> value{};
                         for (std::size_t i = 0; i < n; ++i) {
                           if (!(v.numbers[i] >= low && v.numbers[i] <= high)) return "outside its range";
                           value[i] = v.numbers[i];
                         }
                         access(s, slot) = value;
                         return {};
                       }});
  }
  template <class Access>
  void texts(const char* path, const char* standard, const char* meaning, Access access) {
    entries.push_back({{path, Type::texts, "", standard, "list of texts", meaning},
                       [=](Scenario& s, const Slot& slot, const ScenarioValue& v) -> std::string {
                         access(s, slot) = v.texts;
                         return {};
                       }});
  }
};

Table::Table() {
  text(
      "name", "\"insertion\"", "what the report calls this run",
      [](Scenario & s, const Slot&) -> auto& { return s.name; });

  text(
      "patient.source", "",
      "contours (RTSTRUCT, JSON), label mask or tetrahedral mesh; relative to the scenario file; \"phantom\" is the "
      "demo patient",
      [](Scenario & s, const Slot&) -> auto& { return s.patient.source; });
  text(
      "patient.regions.<name>", "", "region name for a structure (by its name) or a label (by its number)",
      [](Scenario & s, const Slot& slot) -> auto& { return s.patient.regions[slot.name]; });
  number(
      "patient.scale", "mm", "0", 0, 1e6, "length of the mesh file's unit; 0 = as the file says, else mm",
      [](Scenario & s, const Slot&) -> auto& { return s.patient.scale; });

  number(
      "tissue.<region>.young_kPa", "kPa", "by region", 0.1, 1e8, "Young's modulus",
      [](Scenario & s, const Slot& t) -> auto& { return tissue(s, t).young_kPa; });
  number(
      "tissue.<region>.poisson", "", "0.45", 0.0, 0.4999, "Poisson ratio; linear tetrahedra stiffen towards 0.5",
      [](Scenario & s, const Slot& t) -> auto& { return tissue(s, t).poisson; });
  number(
      "tissue.<region>.cutting_N", "N", "by region", 0.0, 100, "axial force at which the tip cuts",
      [](Scenario & s, const Slot& t) -> auto& { return tissue(s, t).cutting_N; });
  number(
      "tissue.<region>.puncture_N", "N", "by region", 0.0, 100,
      "force that breaks the surface around the region; 0 = no membrane",
      [](Scenario & s, const Slot& t) -> auto& { return tissue(s, t).puncture_N; });
  number(
      "tissue.<region>.friction_static_N_per_m", "N/m", "18", 0.0, 1e4,
      "largest friction per inserted length while sticking",
      [](Scenario & s, const Slot& t) -> auto& { return tissue(s, t).friction_static_N_per_m; });
  number(
      "tissue.<region>.friction_coulomb_N_per_m", "N/m", "11", 0.0, 1e4,
      "friction per inserted length while sliding slowly",
      [](Scenario & s, const Slot& t) -> auto& { return tissue(s, t).friction_coulomb_N_per_m; });
  number(
      "tissue.<region>.friction_viscous_Ns_per_m2", "N s/m²", "250", 0.0, 1e6, "growth of sliding friction with speed",
      [](Scenario & s, const Slot& t) -> auto& { return tissue(s, t).friction_viscous_Ns_per_m2; });

  texts(
      "fixed.regions", "bones",
      "regions whose nodes are all held; default: pubic_arch, femur_left, femur_right where present",
      [](Scenario & s, const Slot&) -> auto& { return s.fixed.regions; });
  choice(
      "fixed.outer", "\"auto\"", {"auto", "none", "sides", "all"}, {},
      "outer faces held: sides = all but the perineal face and the surroundings of the entry; auto = none with a pubic "
      "arch, else sides",
      [](Scenario & s, const Slot&) -> auto& { return s.fixed.outer; });
  vector<6>(
      "fixed.box_mm", "mm", "none", -1e5, 1e5,
      "nodes inside this box (x, y, z low; x, y, z high; LPS) are held as well",
      [](Scenario & s, const Slot&) -> auto& { return s.fixed.box_mm; });

  integer(
      "mesh.nodes", "0", 0, 1000000, "nodes of the mesh; 0 = 3,000 (standard) or 570 (paper)",
      [](Scenario & s, const Slot&) -> auto& { return s.mesh.nodes; });
  choice(
      "mesh.preset", "\"standard\"", {"standard", "paper"}, {},
      "paper: the target and its surroundings only, as Goksel et al. 2005",
      [](Scenario & s, const Slot&) -> auto& { return s.mesh.preset; });
  number(
      "mesh.cull_mm", "mm", "0.3", 0.0, 5.0, "contour points nearer than this to the contour without them are dropped",
      [](Scenario & s, const Slot&) -> auto& { return s.mesh.cull_mm; });
  boolean(
      "mesh.stiff_band", "true", "without a pubic arch: add the band that holds the gland's anterior-inferior end",
      [](Scenario & s, const Slot&) -> auto& { return s.mesh.stiff_band; });

  choice(
      "needle.model", "\"beam\"", {"beam"}, {"springs", "tet"}, "needle model",
      [](Scenario & s, const Slot&) -> auto& { return s.needle.model; });
  number(
      "needle.length_mm", "mm", "200", 20, 1000, "base to tip",
      [](Scenario & s, const Slot&) -> auto& { return s.needle.length_mm; });
  number(
      "needle.diameter_mm", "mm", "1.27", 0.2, 5, "outer diameter; 18 gauge is 1.27",
      [](Scenario & s, const Slot&) -> auto& { return s.needle.diameter_mm; });
  number(
      "needle.bending_stiffness_Nmm2", "N mm²", "15700", 1, 1e7,
      "E I; 12,700 … 25,500 for 18 gauge, by lumen and stylet",
      [](Scenario & s, const Slot&) -> auto& { return s.needle.bending_stiffness_Nmm2; });
  number(
      "needle.torsion_stiffness_Nmm2", "N mm²", "12100", 1, 1e7, "G J",
      [](Scenario & s, const Slot&) -> auto& { return s.needle.torsion_stiffness_Nmm2; });
  integer(
      "needle.elements", "24", 4, 200, "elements of the needle",
      [](Scenario & s, const Slot&) -> auto& { return s.needle.elements; });

  choice(
      "coupling.method", "\"node-addition\"", {"node-addition", "embedded"}, {"near-field", "node-repositioning"},
      "how the tissue's mesh takes the needle", [](Scenario & s, const Slot&) -> auto& { return s.coupling.method; });
  choice(
      "coupling.rule", "\"interior\"", {"interior", "paper"}, {},
      "where nodes are added: inside elements at the contact spacing, or on every face crossed",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.rule; });
  choice(
      "coupling.solver", "\"coupled\"", {"coupled"}, {"staggered"}, "needle and tissue in one solve",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.solver; });
  choice(
      "coupling.engine", "\"condensed\"", {"condensed"}, {"woodbury", "bcs"}, "what is kept of K⁻¹",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.engine; });
  number(
      "coupling.spacing_mm", "mm", "4", 1, 50, "between contacts; never closer than the needle's diameter",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.spacing_mm; });
  number(
      "coupling.tip_viscosity_Ns_per_m", "N s/m", "2", 0.01, 1000,
      "growth of the cutting force with the speed of cutting",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.tip_viscosity_Ns_per_m; });
  number(
      "coupling.grazing_deg", "degree", "80", 30, 89,
      "a needle flatter to the skin than this (angle to the normal) slides off",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.grazing_deg; });
  number(
      "coupling.corridor_mm", "mm", "8", 1, 50,
      "around the planned path, where compliance is computed before the start",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.corridor_mm; });
  integer(
      "coupling.contacts", "96", 8, 400, "largest number of contacts",
      [](Scenario & s, const Slot&) -> auto& { return s.coupling.contacts; });

  number(
      "template.pitch_mm", "mm", "5", 1, 20, "distance of neighbouring holes",
      [](Scenario & s, const Slot&) -> auto& { return s.grid.pitch_mm; });
  vector<2>(
      "template.centre_mm", "mm", "target's centroid", -1e4, 1e4, "LPS x and y of the middle hole (D4)",
      [](Scenario & s, const Slot&) -> auto& { return s.grid.centre_mm; });
  texts(
      "template.columns", "A a B b C c D d E e F f G", "column names from the patient's right to the left",
      [](Scenario & s, const Slot&) -> auto& { return s.grid.columns; });
  texts(
      "template.rows", "1 1.5 2 … 7", "row names from posterior to anterior",
      [](Scenario & s, const Slot&) -> auto& { return s.grid.rows; });

  text(
      "insertion[].hole", "", "template hole, for example \"D4\" or \"d3.5\"; the needle goes along +z (superior)",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).hole; });
  vector<3>(
      "insertion[].entry_mm", "mm", "none", -1e4, 1e4, "a point on the needle's line, LPS, instead of a hole",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).entry_mm; });
  vector<3>(
      "insertion[].direction", "", "[0, 0, 1]", -1e4, 1e4, "of the insertion, LPS, any length",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).direction; });
  vector<3>(
      "insertion[].target_mm", "mm", "none", -1e4, 1e4, "a point to aim at, LPS, instead of a direction",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).target_mm; });
  number(
      "insertion[].approach_mm", "mm", "3", 0.1, 200, "free travel before the skin",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).approach_mm; });
  number(
      "insertion[].depth_mm", "mm", "0", 0, 1000, "base travel beyond skin contact; 0 = to the far end of the target",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).depth_mm; });
  number(
      "insertion[].speed_mm_per_s", "mm/s", "20", 0.01, 1000, "of the base going in",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).speed_mm_per_s; });
  number(
      "insertion[].dwell_s", "s", "0.3", 0, 3600, "pause at full depth",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).dwell_s; });
  number(
      "insertion[].retract_speed_mm_per_s", "mm/s", "20", 0.01, 1000, "of the base going out",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).retract_speed_mm_per_s; });
  boolean(
      "insertion[].retract", "true", "pull the needle out after the pause",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).retract; });
  text(
      "insertion[].motion", "",
      "CSV of a recorded base motion (time_s, x_mm, y_mm, z_mm, qw, qx, qy, qz) instead of all the above",
      [](Scenario & s, const Slot& i) -> auto& { return plan(s, i).motion; });

  number(
      "run.dt_ms", "ms", "1", 0.01, 20, "time step", [](Scenario & s, const Slot&) -> auto& { return s.run.dt_ms; });

  number(
      "output.frames_per_s", "1/s", "8", 0, 1000, "frames kept for pictures and ParaView",
      [](Scenario & s, const Slot&) -> auto& { return s.output.frames_per_s; });
  integer(
      "output.max_frames", "80", 2, 5000, "at most this many frames",
      [](Scenario & s, const Slot&) -> auto& { return s.output.max_frames; });
  boolean(
      "output.pictures", "true", "still pictures in the report",
      [](Scenario & s, const Slot&) -> auto& { return s.output.pictures; });
}

const Table& table() {
  static const Table instance;
  return instance;
}

/// "tissue.prostate.young_kPa" → "tissue.<region>.young_kPa" and the slot; "insertion[2].hole" → "insertion[].hole".
std::string pattern_of(const std::string& path, Slot& slot) {
  if (path.rfind("tissue.", 0) == 0) {
    const auto dot = path.rfind('.');
    if (dot > 7) {
      slot.name = path.substr(7, dot - 7);
      return "tissue.<region>" + path.substr(dot);
    }
  }
  if (path.rfind("patient.regions.", 0) == 0) {
    slot.name = path.substr(16);
    return "patient.regions.<name>";
  }
  if (path.rfind("insertion[", 0) == 0) {
    const auto close = path.find(']');
    if (close != std::string::npos && close > 10 && path.find_first_not_of("0123456789", 10) == close && close < 14) {
      slot.index = std::stoul(path.substr(10, close - 10));
      return "insertion[]" + path.substr(close + 1);
    }
  }
  return path;
}

const char* type_name(Type type) {
  switch (type) {
    case Type::number:
      return "a number";
    case Type::integer:
      return "a whole number";
    case Type::boolean:
      return "true or false";
    case Type::text:
      return "a text in quotes";
    case Type::numbers:
      return "a list of numbers";
    case Type::texts:
      return "a list of texts";
  }
  return "";
}

bool fits(const ScenarioValue& value, Type type) {
  if (value.type == type) return true;
  if (type == Type::number || type == Type::integer) return value.type == Type::number || value.type == Type::integer;
  // An empty list has no type of its own.
  if (type == Type::numbers || type == Type::texts) {
    return (value.type == Type::numbers || value.type == Type::texts) && value.numbers.empty() && value.texts.empty();
  }
  return false;
}

std::string shown(const ScenarioValue& value) {
  switch (value.type) {
    case Type::number:
    case Type::integer:
      return number_text(value.number);
    case Type::boolean:
      return value.boolean ? "true" : "false";
    case Type::text:
      return "\"" + value.text + "\"";
    case Type::numbers:
      return "a list of " + std::to_string(value.numbers.size()) + " numbers";
    case Type::texts:
      return "a list of " + std::to_string(value.texts.size()) + " texts";
  }
  return "";
}

}  // namespace

const std::vector<ScenarioKey>& scenario_keys() {
  static const std::vector<ScenarioKey> keys = [] {
    std::vector<ScenarioKey> all;
    for (const Entry& entry : table().entries) all.push_back(entry.key);
    return all;
  }();
  return keys;
}

Result<> set_scenario_key(Scenario& scenario, const std::string& path, const ScenarioValue& value,
                          const std::string& where) {
  Slot slot;
  const std::string pattern = pattern_of(path, slot);
  for (const Entry& entry : table().entries) {
    if (entry.key.path != pattern) continue;
    const std::string unit = entry.key.unit.empty() ? "" : " " + entry.key.unit;
    if (!fits(value, entry.key.type)) {
      return input_error(where, path + " = " + shown(value) + " is not " + type_name(entry.key.type),
                         "Give " + std::string(type_name(entry.key.type)) + ", " + entry.key.range + unit);
    }
    if (value.type == Type::number && !std::isfinite(value.number)) {
      return input_error(where, path + " is not finite", "Give a value in " + entry.key.range + unit);
    }
    const std::string refusal = entry.store(scenario, slot, value);
    if (refusal.empty()) return Ok{};
    std::string cure = "Give a value in " + entry.key.range + unit;
    if (entry.key.type == Type::text) cure = "Give one of " + entry.key.range;
    return input_error(where, path + " = " + shown(value) + " is " + refusal, cure);
  }
  std::vector<std::string> known;
  for (const Entry& entry : table().entries) known.push_back(entry.key.path);
  std::string near = nearest_name(pattern, known);
  // Show the name in the user's own words.
  if (const auto at = near.find("<region>"); at != std::string::npos)
    near.replace(at, 8, slot.name.empty() ? "REGION" : slot.name);
  if (const auto at = near.find("[]"); at != std::string::npos)
    near.replace(at, 2, "[" + std::to_string(slot.index) + "]");
  return input_error(where, "unknown key " + path,
                     near.empty() ? "See stylet insert --print-schema for all keys"
                                  : "Did you mean " + near + "? stylet insert --print-schema lists all keys");
}

Result<> check_scenario(const Scenario& s, const std::string& where) {
  if (s.patient.source.empty()) {
    return input_error(where, "no patient: patient.source is missing",
                       "Name a contour set, mask or mesh, or \"phantom\"");
  }
  if (s.insertions.empty()) {
    return input_error(where, "no needle: there is no [[insertion]]",
                       "Add an [[insertion]] with a hole or an entry_mm");
  }
  for (std::size_t i = 0; i < s.insertions.size(); ++i) {
    const InsertionPlan& p = s.insertions[i];
    const std::string name = "insertion[" + std::to_string(i) + "]";
    if (!p.motion.empty()) continue;
    if (p.hole.has_value() == p.entry_mm.has_value()) {
      return input_error(where, name + (p.hole ? " has both hole and entry_mm" : " has neither hole nor entry_mm"),
                         "Give one of the two");
    }
    if (p.hole) {
      if (const auto offset = s.grid.offset_mm(*p.hole); !offset)
        return input_error(where + ", " + name, offset.error().where + " " + offset.error().what, offset.error().cure);
      if (p.direction || p.target_mm) {
        return input_error(where, name + " has a hole and a direction; a template holds the needle along +z",
                           "Use entry_mm with a direction");
      }
    }
    if (p.direction && p.target_mm)
      return input_error(where, name + " has both direction and target_mm", "Give one of the two");
    if (p.direction && Vec3(p.direction->data()).norm() < 1e-9)
      return input_error(where, name + ".direction is zero", "Give a direction such as [0, 0, 1]");
    if (p.depth_mm > 0.0 && p.depth_mm > s.needle.length_mm - 5.0) {
      return input_error(where,
                         name + ".depth_mm = " + number_text(p.depth_mm) +
                             " is more than the needle's length less 5 mm (" + number_text(s.needle.length_mm - 5.0) +
                             ")",
                         "Use a longer needle or a smaller depth");
    }
  }
  if (s.coupling.spacing_mm < s.needle.diameter_mm) {
    return input_error(where,
                       "coupling.spacing_mm = " + number_text(s.coupling.spacing_mm) +
                           " is less than the needle's diameter, " + number_text(s.needle.diameter_mm),
                       "Contacts closer than the diameter cannot be told apart: give at least the diameter");
  }
  for (const auto& [region, t] : s.tissue) {
    if (t.friction_coulomb_N_per_m > t.friction_static_N_per_m) {
      return input_error(where,
                         "tissue." + region + ": sliding friction " + number_text(t.friction_coulomb_N_per_m) +
                             " N/m exceeds static friction " + number_text(t.friction_static_N_per_m) + " N/m",
                         "Static friction is the larger of the two");
    }
  }
  return Ok{};
}

}  // namespace stylet
