// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/hole_map_io.hpp"

#include "fixed_number.hpp"
#include "output_folder.hpp"
#include "record/json.hpp"
#include "record/summary_columns.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace stylet {
using namespace results;

namespace {

using record::Json;

constexpr int kMapDigits = 6;  // mm: a nanometre

std::string field(const std::optional<double>& value) { return value ? fixed(*value, kMapDigits) : ""; }

std::string length_field(const std::optional<Vec3>& v) {
  return v && v->allFinite() ? fixed(v->norm(), kMapDigits) : "";
}

Json anatomical_json(const std::optional<Vec3>& v) { return v ? record::anatomical(*v) : Json(nullptr); }

/// The remark on a hole: why it has no figures, or remarks of its prediction.
std::string remark_of(const HoleRow& row) {
  if (!row.failed.empty()) return row.failed;
  return row.prediction ? fmt::format("{}", fmt::join(row.prediction->remarks, " ")) : "";
}

Json hole_json(const HoleRow& row) {
  Json clearance;
  for (std::size_t i = 0; i < kSpared.size(); ++i)
    clearance[to_string(kSpared[i])] = row.clearance_mm[i] ? Json(*row.clearance_mm[i]) : Json(nullptr);
  const Prediction prediction = row.prediction.value_or(Prediction{});
  Json json{{"hole", row.hole},
            {"left_mm", row.left_mm},
            {"anterior_mm", row.anterior_mm},
            {"depth_mm", row.depth_mm},
            {"in_target_mm", row.in_target_mm},
            {"clearance_mm", clearance},
            {"shift_at_break_mm", anatomical_json(prediction.shift_at_break_mm)},
            {"shift_max_mm", anatomical_json(prediction.shift_max_mm)},
            {"tip_error_mm", anatomical_json(prediction.tip_error_mm)},
            {"predicted", row.prediction.has_value()},
            {"remark", remark_of(row)}};
  if (prediction.in_place) json["in_place"] = record::json_of(*prediction.in_place);
  return json;
}

}  // namespace

std::string hole_map_csv(const HoleMap& map) {
  std::string text = "hole,left_mm,anterior_mm,depth_mm,in_target_mm";
  for (const Spared structure : kSpared) text += fmt::format(",clearance_{}_mm", to_string(structure));
  text += ",shift_at_break_mm,shift_max_mm,tip_error_mm";
  const bool beside = !map.in_place.empty();
  if (beside) text += ",in_place_shift_at_break_mm,in_place_shift_max_mm,in_place_tip_error_mm";
  text += ",remark\n";
  for (const HoleRow& row : map.holes) {
    text += row.hole;
    for (const double value : {row.left_mm, row.anterior_mm, row.depth_mm, row.in_target_mm})
      text += "," + fixed(value, kMapDigits);
    for (const auto& clearance : row.clearance_mm) text += "," + field(clearance);
    const Prediction prediction = row.prediction.value_or(Prediction{});
    for (const auto& vector : {prediction.shift_at_break_mm, prediction.shift_max_mm, prediction.tip_error_mm})
      text += "," + length_field(vector);
    const NeedlesInPlace held = prediction.in_place.value_or(NeedlesInPlace{});
    for (const auto& vector : {held.shift_at_break_mm, held.shift_max_mm, held.tip_error_mm})
      text += beside ? "," + length_field(vector) : "";
    text += "," + csv_text(remark_of(row)) + "\n";
  }
  return text;
}

std::string hole_map_json(const HoleMap& map) {
  Json holes = Json::array();
  for (const HoleRow& row : map.holes) holes.push_back(hole_json(row));
  const Json json{{"columns", map.columns},   {"rows", map.rows},         {"pitch_mm", map.pitch_mm},
                  {"planned", map.planned},   {"in_place", map.in_place}, {"missing", map.missing},
                  {"holes", std::move(holes)}};
  return record::compact(json);
}

}  // namespace stylet
