// SPDX-License-Identifier: GPL-3.0-or-later
// Plans in JSON (docs/formats.md).
#include "dose/dose_parsers.hpp"
#include "dose/json_object.hpp"
#include "dose/plan_builder.hpp"
#include "dose/plan_words.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/io/files.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet {

namespace {

using detail::JsonObject;
using detail::PlanBuilder;
using detail::PlanTemplate;

const std::vector<std::string> kPlanKeys{"format",    "version",         "units",  "frame",      "frame_of_reference",
                                         "label",     "implant",         "source", "strength_U", "strength_date",
                                         "plan_date", "prescription_Gy", "seeds",  "template",   "needles"};
const std::vector<std::string> kSeedKeys{"position_mm", "axis", "strength_U", "needle", "dwell_s", "source"};
const std::vector<std::string> kTemplateKeys{"origin_mm",        "pitch_mm",     "columns",  "rows",
                                             "direction",        "left",         "anterior", "seed_length_mm",
                                             "spacer_length_mm", "tip_offset_mm"};
const std::vector<std::string> kNeedleKeys{"hole", "retraction_mm", "train", "strength_U"};

/// The first error of several results.
template <class... R>
Result<> all_of(R... results) {
  Result<> first = Ok{};
  const auto keep = [&](const Result<>& result) {
    if (first && !result) first = result;
  };
  (keep(results), ...);
  return first;
}

Result<> take_words(const JsonObject& object, const std::string& key, std::vector<std::string>& words) {
  if (!object.has(key)) return Ok{};
  words.clear();
  if (object.at(key).is_array()) {
    for (const auto& word : object.at(key)) {
      if (word.is_string()) words.push_back(word.get<std::string>());
    }
  }
  if (!words.empty() && words.size() == object.at(key).size()) return Ok{};
  return input_error(object.place(key), "a list of names in quotes is expected", "Write e.g. [\"A\", \"a\", \"B\"]");
}

Result<> read_header(const JsonObject& object, PlanBuilder& builder, double& strength_U) {
  if (Result<> keys = object.check_keys(kPlanKeys); !keys) return keys;
  std::string units, frame, implant = "permanent";
  DosePlan& plan = builder.plan;
  Result<> taken = all_of(object.take("units", units), object.take("frame", frame), object.take("implant", implant),
                          object.take("frame_of_reference", plan.frame_of_reference), object.take("label", plan.label),
                          object.take("source", plan.source_model), object.take("strength_U", strength_U),
                          object.take("strength_date", plan.strength_date), object.take("plan_date", plan.plan_date),
                          object.take("prescription_Gy", plan.prescription_Gy));
  if (!taken) return taken;
  if (units != "mm")
    return input_error(object.place("units"), fmt::format("the units are '{}', 'mm' is expected", units),
                       "Convert all coordinates to millimetres and write \"units\": \"mm\"");
  plan.source_id = plan.source_model;
  if (frame != "LPS")
    return input_error(object.place("frame"), fmt::format("the frame is '{}', 'LPS' is expected", frame),
                       "Convert to DICOM patient coordinates (+x left, +y posterior, +z superior)");
  return detail::set_implant(implant, object.place("implant"), plan);
}

Result<> read_seed(const JsonObject& object, double strength_U, PlanBuilder& builder) {
  if (Result<> keys = object.check_keys(kSeedKeys); !keys) return keys;
  if (!object.has("position_mm"))
    return input_error(object.where(), "the seed has no position_mm", "Give [x, y, z] in mm, LPS");
  PlannedSource seed;
  std::string model;
  seed.strength_U = strength_U;
  seed.has_axis = object.has("axis");
  Result<> taken = all_of(object.take("position_mm", seed.at_mm), object.take("axis", seed.axis),
                          object.take("strength_U", seed.strength_U), object.take("needle", seed.needle),
                          object.take("dwell_s", seed.dwell_s), object.take("source", model));
  if (!taken) return taken;
  const Result<std::size_t> kind = builder.kind_of(model, object.where());
  if (!kind) return kind.error();
  seed.kind = *kind;
  if (!object.has("dwell_s")) ++builder.plan.says.without_dwell_time;
  return builder.add(seed, object.where());
}

Result<> read_template(const JsonObject& object, PlanTemplate& grid) {
  if (Result<> keys = object.check_keys(kTemplateKeys); !keys) return keys;
  if (!object.has("origin_mm"))
    return input_error(object.where(), "the template has no origin_mm",
                       "Give the place where the axis of hole D4 meets the base plane, [x, y, z] in mm");
  double tip = NAN;
  Result<> taken = all_of(object.take("origin_mm", grid.origin_mm), object.take("pitch_mm", grid.grid.pitch_mm),
                          take_words(object, "columns", grid.grid.columns), take_words(object, "rows", grid.grid.rows),
                          object.take("direction", grid.direction), object.take("left", grid.left),
                          object.take("anterior", grid.anterior), object.take("seed_length_mm", grid.lengths.seed_mm),
                          object.take("spacer_length_mm", grid.lengths.spacer_mm), object.take("tip_offset_mm", tip));
  if (!taken) return taken;
  if (std::isfinite(tip)) grid.tip_offset_mm = tip;
  return detail::check_template(grid, object.where());
}

Result<> read_needle(const JsonObject& object, double strength_U, const PlanTemplate& grid, PlanBuilder& builder) {
  if (Result<> keys = object.check_keys(kNeedleKeys); !keys) return keys;
  detail::PlanNeedle needle;
  needle.strength_U = strength_U;
  Result<> taken =
      all_of(object.take("hole", needle.hole), object.take("train", needle.train),
             object.take("retraction_mm", needle.retraction_mm), object.take("strength_U", needle.strength_U));
  return taken ? builder.add(needle, grid, object.where()) : taken;
}

/// Calls read(object) for each object of a list.
template <class Read>
Result<> for_each_object(const JsonObject& parent, const std::string& key, const char* name, const Read& read) {
  if (!parent.has(key)) return Ok{};
  if (!parent.at(key).is_array())
    return input_error(parent.place(key), "a list in brackets is expected", "Write a list of objects");
  int number = 0;
  for (const auto& item : parent.at(key)) {
    const JsonObject object(item, fmt::format("{}, {} {}", parent.where(), name, ++number));
    if (Result<> done = read(object); !done) return done;
  }
  return Ok{};
}

}  // namespace

Result<DosePlan> detail::parse_plan_json(const std::filesystem::path& path) {
  const Result<nlohmann::json> json = read_json(path, "stylet-plan", 1);
  if (!json) return json.error();
  PlanBuilder builder(path.string());
  const JsonObject object(*json, path.string());
  double strength_U = 0.0;
  if (Result<> header = read_header(object, builder, strength_U); !header) return header.error();
  Result<> seeds = for_each_object(object, "seeds", "seed",
                                   [&](const JsonObject& seed) { return read_seed(seed, strength_U, builder); });
  if (!seeds) return seeds.error();
  if (object.has("needles")) {
    PlanTemplate grid;
    if (!object.has("template"))
      return input_error(path.string(), "the plan has needles, but no template", "Add \"template\" with its origin_mm");
    const JsonObject of_template(object.at("template"), path.string() + ", 'template'");
    if (Result<> read = read_template(of_template, grid); !read) return read.error();
    Result<> needles = for_each_object(object, "needles", "needle", [&](const JsonObject& needle) {
      return read_needle(needle, strength_U, grid, builder);
    });
    if (!needles) return needles.error();
  }
  return builder.finish();
}

Result<> write_plan_json(const DosePlan& plan, const std::filesystem::path& path) {
  nlohmann::ordered_json json{{"format", "stylet-plan"}, {"version", 1}, {"units", "mm"}, {"frame", "LPS"}};
  const auto text = [&](const char* key, const std::string& value) {
    if (!value.empty()) json[key] = value;
  };
  text("label", plan.label);
  text("frame_of_reference", plan.frame_of_reference);
  json["implant"] = to_string(plan.implant);
  if (kind_count(plan) == 1) text("source", plan.source_model);
  text("strength_date", plan.strength_date);
  text("plan_date", plan.plan_date);
  if (plan.prescription_Gy > 0.0) json["prescription_Gy"] = plan.prescription_Gy;
  for (const PlannedSource& s : plan.sources) {
    nlohmann::ordered_json seed{{"position_mm", {s.at_mm.x(), s.at_mm.y(), s.at_mm.z()}}, {"strength_U", s.strength_U}};
    if (s.has_axis) seed["axis"] = {s.axis.x(), s.axis.y(), s.axis.z()};
    if (!s.needle.empty()) seed["needle"] = s.needle;
    if (plan.implant == Implant::temporary) seed["dwell_s"] = s.dwell_s;
    if (kind_count(plan) > 1) seed["source"] = source_kind(plan, s.kind).source_model;
    json["seeds"].push_back(seed);
  }
  return write_whole_file(path, json_text(json, 1) + '\n');
}

}  // namespace stylet
