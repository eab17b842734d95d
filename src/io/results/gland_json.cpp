// SPDX-License-Identifier: GPL-3.0-or-later
#include "gland_json.hpp"

#include <limits>

namespace stylet::results {

using Json = nlohmann::ordered_json;

namespace {

/// A vector; its components are NaN if it is null.
Vec3 certain(const Json& json) {
  return vector_of(json).value_or(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace

Json vector_json(const std::optional<Vec3>& v) {
  if (!v || !v->allFinite()) return nullptr;
  return {{"LR", v->x()}, {"AP", v->y()}, {"SI", v->z()}, {"norm", v->norm()}};
}

std::optional<Vec3> vector_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return Vec3(json.at("LR").get<double>(), json.at("AP").get<double>(), json.at("SI").get<double>());
}

Json in_place_json(const NeedlesInPlace& in_place) {
  return {{"holes", in_place.holes},
          {"shift_mm", vector_json(in_place.shift_mm)},
          {"shift_at_break_mm", vector_json(in_place.shift_at_break_mm)},
          {"shift_max_mm", vector_json(in_place.shift_max_mm)},
          {"tip_error_mm", vector_json(in_place.tip_error_mm)},
          {"remarks", in_place.remarks}};
}

NeedlesInPlace in_place_of(const Json& json) {
  return {.holes = json.at("holes").get<std::vector<std::string>>(),
          .shift_mm = vector_of(json.at("shift_mm")),
          .shift_at_break_mm = vector_of(json.at("shift_at_break_mm")),
          .shift_max_mm = vector_of(json.at("shift_max_mm")),
          .tip_error_mm = vector_of(json.at("tip_error_mm")),
          .remarks = json.at("remarks").get<std::vector<std::string>>()};
}

Json gland_json(const std::optional<GlandMotion>& gland) {
  if (!gland) return nullptr;
  const PlaneAngles angles = plane_angles(gland->rotation_deg);
  return {
      {"shift_at_break_mm", vector_json(gland->shift_at_break_mm)},
      {"shift_max_mm", vector_json(gland->shift_max_mm)},
      {"shift_in_place_mm", vector_json(gland->shift_in_place_mm)},
      {"shift_residual_mm", vector_json(gland->shift_residual_mm)},
      {"rotation_deg", {{"coronal", angles.coronal}, {"sagittal", angles.sagittal}, {"transverse", angles.transverse}}},
      {"base_mm", vector_json(gland->base_mm)},
      {"mid_mm", vector_json(gland->mid_mm)},
      {"apex_mm", vector_json(gland->apex_mm)},
      {"volume_change_percent", gland->volume_change_percent}};
}

std::optional<GlandMotion> gland_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  const auto number = [](const Json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  };
  GlandMotion gland;
  gland.shift_at_break_mm = vector_of(json.at("shift_at_break_mm"));
  gland.shift_max_mm = certain(json.at("shift_max_mm"));
  gland.shift_in_place_mm = certain(json.at("shift_in_place_mm"));
  gland.shift_residual_mm = vector_of(json.at("shift_residual_mm"));
  const Json& angles = json.at("rotation_deg");
  gland.rotation_deg =
      rotation_of({number(angles.at("coronal")), number(angles.at("sagittal")), number(angles.at("transverse"))});
  gland.base_mm = certain(json.at("base_mm"));
  gland.mid_mm = certain(json.at("mid_mm"));
  gland.apex_mm = certain(json.at("apex_mm"));
  gland.volume_change_percent = number(json.at("volume_change_percent"));
  return gland;
}

}  // namespace stylet::results
