// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr double kStiff_kPa = 1e4;  ///< defaults above this are bone, whose modulus has no effect

constexpr const char* kCm = "A length in cm has to be multiplied by 10, one in m by 1000";
constexpr const char* kMicrometre = "A length in µm has to be divided by 1000";
constexpr const char* kMetresPerSecond = "A speed in m/s has to be multiplied by 1000, one in cm/s by 10";
constexpr const char* kPerMinute = "A speed in mm/min has to be divided by 60, one in µm/s by 1000";
constexpr const char* kMilliseconds = "A time in ms has to be divided by 1000";
constexpr const char* kMillinewton = "A force in mN has to be divided by 1000";
constexpr const char* kPerMillimetre = "Friction in N/mm has to be multiplied by 1000, in N/cm by 100";
constexpr const char* kPerArea =
    "Friction is a force per inserted length, not per area (kPa): multiply a stress by the "
    "needle's circumference; mN/m has to be divided by 1000";

/// The values of a scenario's key with this pattern, with their paths.
std::vector<std::pair<std::string, double>> values_of(const Scenario& scenario, const std::string& pattern) {
  std::vector<std::string> paths;
  const auto fill = [&](std::string_view wildcard, const std::string& by) {
    std::string path = pattern;
    path.replace(path.find(wildcard), wildcard.size(), by);
    paths.push_back(path);
  };
  if (pattern.find("<region>") != std::string::npos) {
    for (const auto& [region, parameters] : scenario.tissue) fill("<region>", region);
  } else if (pattern.starts_with("insertion[]")) {
    for (std::size_t i = 0; i < scenario.insertions.size(); ++i) {
      if (scenario.insertions[i].motion.empty()) fill("[]", fmt::format("[{}]", i));
    }
  } else if (pattern.starts_with("plan.needle[]")) {
    for (std::size_t i = 0; i < scenario.plan.needles.size(); ++i) fill("[]", fmt::format("[{}]", i));
  } else if (pattern.find("[]") == std::string::npos) {
    paths.push_back(pattern);
  }
  std::vector<std::pair<std::string, double>> values;
  for (const std::string& path : paths) {
    const auto value = scenario_value(scenario, path);
    if (value && (value->type == ScenarioValue::Type::number || value->type == ScenarioValue::Type::integer))
      values.emplace_back(path, value->number);
  }
  return values;
}

/// The value that the key has if the scenario does not give it; NaN if it has none.
double default_of(const Scenario& scenario, const std::string& path) {
  Scenario plain;
  plain.tissue_model.preset = scenario.tissue_model.preset;
  for (const auto& [region, parameters] : scenario.tissue)
    plain.tissue[region] = default_tissue(region, scenario.tissue_model.preset);
  plain.insertions.resize(scenario.insertions.size());
  plain.plan.needles.resize(scenario.plan.needles.size());
  const auto value = scenario_value(plain, path);
  return value ? value->number : std::numeric_limits<double>::quiet_NaN();
}

std::string doubt(const PlausibleRange& range, const std::string& unit, const std::string& path, double value) {
  const std::string& advice = value < range.low ? range.below : range.above;
  return fmt::format("{} = {:g} {} is {} than is plausible, {:g} to {:g} {} ({}). {}.", path, value, unit,
                     value < range.low ? "less" : "more", range.low, range.high, unit, range.reason,
                     advice.empty() ? "Check the unit" : advice);
}

/// Whether a number of degrees is probably one of radians: a multiple of 15° in radians, as 0.7854 is of π/12.
bool is_radians(double value) {
  constexpr double twelfth = std::numbers::pi / 12.0;
  const double multiple = std::round(value / twelfth);
  return value != std::round(value) && std::abs(value) < 2.0 * std::numbers::pi + 0.01 && multiple != 0.0 &&
         std::abs(value - multiple * twelfth) < 0.002;
}

}  // namespace

const std::vector<PlausibleRange>& plausible_ranges() {
  static const std::vector<PlausibleRange> ranges{
      {"tissue.<region>.young_kPa", 0.5, 1000, "soft tissue has 1 to 300 kPa",
       "A modulus in MPa has to be multiplied by 1000", "A modulus in Pa has to be divided by 1000"},
      {"tissue.<region>.cutting_N", 0.005, 15, "0.1 to 4 N are published", "", kMillinewton},
      {"tissue.<region>.puncture_N", 0.05, 20, "0.5 to 5 N are published", "", kMillinewton},
      {"tissue.<region>.friction_static_N_per_m", 2, 400, "10 to 150 N/m are published", kPerMillimetre, kPerArea},
      {"tissue.<region>.friction_coulomb_N_per_m", 2, 400, "10 to 150 N/m are published", kPerMillimetre, kPerArea},
      {"tissue.<region>.friction_viscous_Ns_per_m2", 1, 2e4, "needles were measured at 1 to 50 mm/s",
       "Friction in N s/mm² has to be multiplied by 1,000,000", ""},
      {"tissue.creep_s", 0.02, 100, "soft tissue relaxes within 0.1 to 10 s", "", kMilliseconds},
      {"anatomy.periprostatic_fat_mm", 1, 30, "some millimetres", kCm, kMicrometre},
      {"anatomy.levator_mm", 1, 15, "3 to 8 mm", kCm, kMicrometre},
      {"anatomy.ischiorectal_fat_mm", 3, 60, "some centimetres", kCm, kMicrometre},
      {"anatomy.subcutaneous_fat_mm", 1, 60, "some millimetres to centimetres", kCm, kMicrometre},
      {"anatomy.rectal_wall_mm", 1, 10, "2 to 5 mm", kCm, kMicrometre},
      {"needle.length_mm", 60, 500, "needles for the prostate have 150 to 250 mm", kCm, kMicrometre},
      {"needle.diameter_mm", 0.3, 3, "25 gauge to 11 gauge", "A diameter in cm has to be multiplied by 10",
       "18 gauge is 1.27 mm, 17 gauge 1.47 mm"},
      {"needle.young_GPa", 1, 230, "polymers have 1 to 5 GPa, nitinol 30 to 75, steel 200", "", ""},
      {"needle.bending_stiffness_Nmm2", 50, 1e6, "18 gauge steel has about 16,000 N mm²",
       "A stiffness in N m² has to be multiplied by 1,000,000", ""},
      {"needle.bevel_deg", 5, 60, "bevels have 10 to 30 degrees", "An angle in radians has to be multiplied by 57.3",
       ""},
      {"template.pitch_mm", 2, 10, "templates have holes every 5 mm", kCm, kMicrometre},
      {"insertion[].approach_mm", 0.1, 100, "the tip starts just outside of the skin", "", kMicrometre},
      {"insertion[].depth_mm", 8, 300, "the gland lies 40 to 100 mm behind the perineal skin", kCm, kMicrometre},
      {"insertion[].speed_mm_per_s", 0.5, 500, "hands push a needle at 1 to 200 mm/s", kMetresPerSecond, kPerMinute},
      {"insertion[].retract_speed_mm_per_s", 0.5, 500, "hands draw a needle at 1 to 200 mm/s", kMetresPerSecond,
       kPerMinute},
      {"insertion[].dwell_s", 0.001, 60, "a simulated pause takes as many steps as the same time in motion", "",
       kMilliseconds},
      {"plan.seed_length_mm", 1, 10, "seeds are 4 to 5 mm long", kCm, ""},
      {"plan.spacer_length_mm", 1, 20, "spacers are 5 to 6 mm long", kCm, ""},
      {"procedure.speed_mm_per_s", 0.5, 500, "hands push a needle at 1 to 200 mm/s", kMetresPerSecond, kPerMinute},
      {"procedure.drop_speed_mm_per_s", 0.5, 500, "hands draw a needle at 1 to 200 mm/s", kMetresPerSecond, kPerMinute},
      {"procedure.retract_speed_mm_per_s", 0.5, 500, "hands draw a needle at 1 to 200 mm/s", kMetresPerSecond,
       kPerMinute},
      {"run.dt_ms", 0.05, 20, "a step of the loop is 1 ms", "A time step in s has to be multiplied by 1000", ""},
  };
  return ranges;
}

std::string from_the_head(const std::string& name, const Vec3& direction) {
  if (direction.z() >= 0.0) return {};
  return fmt::format(
      "{}: the needle goes from superior to inferior, in the direction ({:.2f}, {:.2f}, {:.2f}) LPS, as if it came "
      "from "
      "the head; a needle through the perineum goes to superior, towards larger z. Reverse the direction, or exchange "
      "entry and target, and check that the patient's z axis points to superior.",
      name, direction.x(), direction.y(), direction.z());
}

std::vector<std::string> warnings_before_start(const Scenario& scenario) {
  std::vector<std::string> warnings;
  const auto unit_of = [](const std::string& pattern) {
    const auto& keys = scenario_keys();
    const auto key = std::find_if(keys.begin(), keys.end(), [&](const ScenarioKey& k) { return k.path == pattern; });
    return key == keys.end() ? std::string() : key->unit;
  };
  for (const PlausibleRange& range : plausible_ranges()) {
    for (const auto& [path, value] : values_of(scenario, range.key)) {
      if (value == 0.0 || (value >= range.low && value <= range.high)) continue;
      const double standard = default_of(scenario, path);
      const bool bone = range.key == "tissue.<region>.young_kPa" && standard > kStiff_kPa;
      if (value == standard || bone) continue;
      warnings.push_back(doubt(range, unit_of(range.key), path, value));
    }
  }
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.unit != "degree") continue;
    for (const auto& [path, value] : values_of(scenario, key.path)) {
      if (!is_radians(value)) continue;
      warnings.push_back(
          fmt::format("{} = {:g} degrees is probably {:.0f} degrees in radians. Write {} = {:.0f} if so.", path, value,
                      value * 180.0 / std::numbers::pi, path, value * 180.0 / std::numbers::pi));
    }
  }
  for (std::size_t i = 0; i < scenario.insertions.size(); ++i) {
    const InsertionPlan& plan = scenario.insertions[i];
    Vec3 direction = Vec3::Zero();
    if (plan.direction) direction = Vec3(plan.direction->data());
    if (plan.target_mm && plan.entry_mm) direction = Vec3(plan.target_mm->data()) - Vec3(plan.entry_mm->data());
    if (std::string head = from_the_head(fmt::format("insertion[{}]", i), direction.normalized()); !head.empty())
      warnings.push_back(std::move(head));
  }
  if (std::string takes_long = long_work_warning(scenario); !takes_long.empty())
    warnings.push_back(std::move(takes_long));
  return warnings;
}

}  // namespace stylet
