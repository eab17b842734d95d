// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of contour JSON (docs/formats.md).
#include "detail/json_text.hpp"
#include "detail/parsers.hpp"
#include "detail/text.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/core/nearest_name.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <fstream>
#include <set>

namespace stylet::detail {

namespace {

using Json = nlohmann::json;

const std::array<std::string, 7> set_keys{"format",    "version", "units", "frame", "label", "frame_of_reference",
                                          "structures"};
const std::array<std::string, 5> structure_keys{"name", "number", "type", "colour", "contours"};

Result<> check_keys(const Json& object, std::span<const std::string> known, const std::string& where) {
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string near = nearest_name(key, known);
    return input_error(where, fmt::format("the key '{}' is unknown", key),
                       !near.empty()
                           ? fmt::format("Did you mean '{}'? Use one of the keys {}", near, fmt::join(known, ", "))
                           : fmt::format("Use one of the keys {}", fmt::join(known, ", ")));
  }
  return Ok{};
}

/// The value of a key that must be a string.
Result<std::string> string_at(const Json& object, const char* key, const std::string& where) {
  if (!object.contains(key)) {
    return input_error(where, fmt::format("the key '{}' is missing", key), "Add it (docs/formats.md)");
  }
  if (!object[key].is_string()) {
    return input_error(where, fmt::format("'{}' is {}, a text is expected", key, object[key].type_name()),
                       "Write it in quotation marks");
  }
  return object[key].get<std::string>();
}

Result<Contour> parse_contour(const Json& json, const std::string& where) {
  if (!json.is_array()) {
    return input_error(where, fmt::format("a contour is {}, a list of points is expected", json.type_name()),
                       "Write [[x, y, z], …]");
  }
  Contour contour;
  contour.points.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string here = fmt::format("{}, point {}", where, i + 1);
    const Json& point = json[i];
    if (!point.is_array() || point.size() != 3) {
      return input_error(here, "a point needs three numbers", "Write [x, y, z] in mm");
    }
    Vec3 value;
    for (int axis = 0; axis < 3; ++axis) {
      if (!point[axis].is_number() || !std::isfinite(point[axis].get<double>())) {
        return input_error(
            here, fmt::format("the coordinate {} is not a finite number", shortened(json_text(point[axis]), 60)),
            "Write [x, y, z] in mm");
      }
      value[axis] = point[axis].get<double>();
    }
    contour.points.push_back(value);
  }
  while (contour.points.size() > 1 && (contour.points.back() - contour.points.front()).norm() < 1e-3) {
    contour.points.pop_back();
  }
  return contour;
}

Result<> parse_colour(const Json& json, const std::string& where, std::array<int, 3>& colour) {
  const bool three = json.is_array() && json.size() == 3;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!three || !json[i].is_number_integer() || json[i].get<long>() < 0 || json[i].get<long>() > 255) {
      return input_error(where,
                         fmt::format("the colour {} is not three whole numbers 0…255", shortened(json_text(json), 60)),
                         "Write \"colour\": [red, green, blue]");
    }
    colour[i] = json[i].get<int>();
  }
  return Ok{};
}

Result<Roi> parse_structure(const Json& json, std::size_t position, const std::string& source) {
  std::string where = fmt::format("{}, structure {}", source, position + 1);
  if (!json.is_object())
    return input_error(where, "the structure is not a JSON object, {…}", "Write it as in docs/formats.md");
  Result<> keys = check_keys(json, structure_keys, where);
  if (!keys) return keys.error();
  Result<std::string> name = string_at(json, "name", where);
  if (!name) return name.error();
  Roi roi;
  roi.name = trimmed(*name);
  if (roi.name.empty()) return input_error(where, "the name is empty", "Name the structure, e.g. \"Prostate\"");
  where = fmt::format("{}, structure '{}'", source, roi.name);
  roi.number = static_cast<int>(position) + 1;
  if (json.contains("number")) {
    if (!json["number"].is_number_integer()) {
      return input_error(where, "'number' is not a whole number", "Write e.g. \"number\": 1");
    }
    roi.number = json["number"].get<int>();
  }
  if (json.contains("type")) {
    Result<std::string> type = string_at(json, "type", where);
    if (!type) return type.error();
    roi.type = *type;
  }
  if (json.contains("colour")) {
    Result<> colour = parse_colour(json["colour"], where, roi.colour);
    if (!colour) return colour.error();
  }
  if (!json.contains("contours") || !json["contours"].is_array()) {
    return input_error(where, "'contours' is missing or not a list", "Write \"contours\": [[[x, y, z], …], …]");
  }
  const Json& contours = json["contours"];
  for (std::size_t i = 0; i < contours.size(); ++i) {
    Result<Contour> contour = parse_contour(contours[i], fmt::format("{}, contour {}", where, i + 1));
    if (!contour) return contour.error();
    roi.contours.push_back(std::move(*contour));
  }
  return roi;
}

/// The name of a structure, even if the structure has other errors; empty if it has no name.
std::string name_of(const Json& structure) {
  const bool named = structure.is_object() && structure.contains("name") && structure["name"].is_string();
  return named ? trimmed(structure["name"].get<std::string>()) : std::string();
}

/// Reads a structure. If it has an error, the message also says how to leave the structure out.
Result<Roi> parse_named_structure(const Json& json, std::size_t position, const std::string& source) {
  Result<Roi> roi = parse_structure(json, position, source);
  if (roi || name_of(json).empty()) return roi;
  Error error = roi.error();
  error.cure += or_skip(name_of(json));
  return error;
}

Result<> check_header(const Json& json, const std::string& source) {
  if (!json.is_object() || !json.contains("format") || json["format"] != "stylet-contours") {
    return input_error(source, "this JSON file does not say \"format\": \"stylet-contours\"",
                       "Name a contour file as docs/formats.md describes it");
  }
  Result<> keys = check_keys(json, set_keys, source);
  if (!keys) return keys.error();
  if (!json.contains("version") || json["version"] != 1) {
    return input_error(source,
                       fmt::format("format version {} is unknown, 1 is expected",
                                   json.contains("version") ? shortened(json_text(json["version"]), 60) : "(none)"),
                       "Write \"version\": 1, or use the Stylet that wrote the file");
  }
  Result<std::string> units = string_at(json, "units", source);
  if (!units) return units.error();
  if (*units != "mm") {
    return input_error(source, fmt::format("units are '{}', 'mm' is expected", *units),
                       "Convert all coordinates to millimetres and write \"units\": \"mm\"");
  }
  Result<std::string> frame = string_at(json, "frame", source);
  if (!frame) return frame.error();
  if (*frame != "LPS") {
    return input_error(
        source, fmt::format("the frame is '{}', 'LPS' is expected", *frame),
        "Convert to DICOM patient coordinates (+x left, +y posterior, +z superior); from RAS negate x and y");
  }
  if (!json.contains("structures") || !json["structures"].is_array() || json["structures"].empty()) {
    return input_error(source, "'structures' is missing or empty", "Add at least one structure (docs/formats.md)");
  }
  return Ok{};
}

}  // namespace

Result<ContourSet> parse_contour_json(const std::filesystem::path& path, std::span<const std::string> skip) {
  const std::string source = path.string();
  const Result<Json> parsed = parse_json_file<Json>(path);
  if (!parsed) return parsed.error();
  const Json& json = *parsed;
  Result<> header = check_header(json, source);
  if (!header) return header.error();

  ContourSet set;
  set.source = source;
  if (json.contains("label")) {
    Result<std::string> label = string_at(json, "label", source);
    if (!label) return label.error();
    set.label = *label;
  }
  if (json.contains("frame_of_reference")) {
    Result<std::string> frame = string_at(json, "frame_of_reference", source);
    if (!frame) return frame.error();
    set.frame_of_reference = *frame;
  }
  std::set<std::string> names;
  const Json& structures = json["structures"];
  for (std::size_t i = 0; i < structures.size(); ++i) {
    Result<Roi> roi = parse_named_structure(structures[i], i, source);
    if (!roi) {
      const std::string name = name_of(structures[i]);
      if (name.empty() || !is_listed(name, skip)) return roi.error();
      set.passed_over.push_back({name, "damaged, and named in [patient] skip"});
      continue;
    }
    if (!names.insert(roi->name).second) {
      return input_error(source, fmt::format("two structures are called '{}'", roi->name),
                         "Give each structure a different name");
    }
    if (roi->contours.empty()) {
      set.passed_over.push_back({roi->name, "empty"});
      continue;
    }
    set.rois.push_back(std::move(*roi));
  }
  if (set.rois.empty()) {
    return input_error(source, "none of its structures has a contour", "Add contours (docs/formats.md)");
  }
  return set;
}

}  // namespace stylet::detail
