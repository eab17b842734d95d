// SPDX-License-Identifier: GPL-3.0-or-later
#include "summary_json.hpp"

#include "gland_json.hpp"
#include "probe_json.hpp"

#include <nlohmann/json.hpp>

#include <limits>
#include <optional>

namespace stylet::results {
namespace {

using Json = nlohmann::ordered_json;

/// The value of an enumeration, from 0 to `last`, that has this name.
template <class Enum>
std::optional<Enum> word(const std::string& name, Enum last) {
  for (int k = 0; k <= static_cast<int>(last); ++k) {
    if (name == to_string(static_cast<Enum>(k))) return static_cast<Enum>(k);
  }
  return std::nullopt;
}

Json in_use(const CapacityUse& use) { return {{"most", use.most}, {"room", use.room}}; }
CapacityUse use_of(const Json& json) { return {json.at("most").get<int>(), json.at("room").get<int>()}; }

/// The target's shift; null without a target.
Json target_shift(const Summary& s) {
  if (s.target_shifts.empty()) return nullptr;
  const Vec3& centroid = s.target_shift_centroid_mm;
  return {{"centroid", {centroid.x(), centroid.y(), centroid.z()}}, {"max", s.target_shift_max_mm}};
}

double number(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace

std::string summary_json(const Summary& s, const ProbeReport* probe) {
  Json events = Json::array();
  for (const Event& e : s.events) {
    events.push_back({{"kind", to_string(e.kind)},
                      {"time_s", e.time_s},
                      {"depth_mm", e.depth_mm},
                      {"force_N", e.force_N},
                      {"region", e.region}});
  }
  Json changes = Json::array();
  for (const MeshChange& m : s.mesh_changes) {
    changes.push_back({{"time_s", m.time_s},
                       {"depth_mm", m.depth_mm},
                       {"kind", to_string(m.change.kind)},
                       {"not_moved_because", to_string(m.change.refused)},
                       {"node", m.change.node},
                       {"dimension", m.change.dimension},
                       {"elements", m.change.elements},
                       {"moved_mm", m.change.moved_mm},
                       {"condition", m.change.condition}});
  }
  Json json = {
      {"version", s.version},
      {"scenario", s.scenario},
      {"mesh", {{"nodes", s.nodes}, {"tets", s.tets}}},
      {"steps", s.steps},
      {"peak_force_N", {{"axial", s.peak_axial_N}, {"sagittal", s.peak_sagittal_N}, {"lateral", s.peak_lateral_N}}},
      {"events", events},
      {"tip_deflection_mm", s.tip_deflection_mm},
      {"tip_error_mm", vector_json(s.tip_error_mm)},
      {"target_shift_mm", target_shift(s)},
      {"gland", gland_json(s.gland)},
      {"residual", {{"force_balance", s.residual_force_balance}, {"torque_balance", s.residual_torque_balance}}},
      {"step_us", {{"p50", s.step_us_p50}, {"p99", s.step_us_p99}, {"p999", s.step_us_p999}, {"max", s.step_us_max}}},
      {"contacts_max", s.contacts_max},
      {"capacity",
       {{"contacts", in_use(s.capacity.contacts)},
        {"spare_nodes", in_use(s.capacity.spare_nodes)},
        {"tracks", in_use(s.capacity.tracks)},
        {"events", in_use(s.capacity.events)}}},
      {"compliance_condition", s.compliance_condition},
      {"mesh_blur_mm",
       {{"min", s.mesh_blur.smallest_mm},
        {"median", s.mesh_blur.median_mm},
        {"max", s.mesh_blur.largest_mm},
        {"nodes", s.mesh_blur.nodes}}},
      {"mesh_changes", changes},
      {"warnings", s.warnings},
  };
  if (probe) json["probe"] = probe_json(*probe);
  if (s.in_place) json["in_place"] = in_place_json(*s.in_place);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Summary> parse_summary_json(std::string_view text, const std::string& where) {
  const auto refuse = [&](const std::string& reason) {
    return input_error(where, "not a summary of a run: " + reason, "Give a file that this version of stylet wrote");
  };
  try {
    const Json json = Json::parse(text);
    Summary s;
    s.version = json.at("version").get<std::string>();
    s.scenario = json.at("scenario").get<std::string>();
    s.nodes = json.at("mesh").at("nodes").get<Index>();
    s.tets = json.at("mesh").at("tets").get<Index>();
    s.steps = json.at("steps").get<Index>();
    const Json& peak = json.at("peak_force_N");
    s.peak_axial_N = number(peak.at("axial"));
    s.peak_sagittal_N = number(peak.at("sagittal"));
    s.peak_lateral_N = number(peak.at("lateral"));
    for (const Json& e : json.at("events")) {
      const auto kind = word(e.at("kind").get<std::string>(), EventKind::grazed);
      if (!kind) return refuse("event kind '" + e.at("kind").get<std::string>() + "' is unknown");
      s.events.push_back({*kind, number(e.at("time_s")), number(e.at("depth_mm")), number(e.at("force_N")),
                          e.at("region").get<std::string>()});
    }
    s.tip_deflection_mm = number(json.at("tip_deflection_mm"));
    if (json.contains("tip_error_mm")) s.tip_error_mm = vector_of(json.at("tip_error_mm"));  // missing in older files
    if (json.contains("in_place")) s.in_place = in_place_of(json.at("in_place"));  // missing without needles in place
    if (const Json& shift = json.at("target_shift_mm"); !shift.is_null()) {
      for (int k = 0; k < 3; ++k)
        s.target_shift_centroid_mm[k] = number(shift.at("centroid").at(static_cast<size_t>(k)));
      s.target_shift_max_mm = number(shift.at("max"));
      s.target_shifts.push_back({s.target_shift_centroid_mm, s.target_shift_max_mm});
    }
    if (json.contains("gland")) s.gland = gland_of(json.at("gland"));  // missing in older files
    s.residual_force_balance = number(json.at("residual").at("force_balance"));
    s.residual_torque_balance = number(json.at("residual").at("torque_balance"));
    const Json& step = json.at("step_us");
    s.step_us_p50 = number(step.at("p50"));
    s.step_us_p99 = number(step.at("p99"));
    s.step_us_p999 = number(step.at("p999"));
    s.step_us_max = number(step.at("max"));
    s.contacts_max = json.at("contacts_max").get<int>();
    if (json.contains("capacity")) {  // missing in older files
      const Json& capacity = json.at("capacity");
      s.capacity = {use_of(capacity.at("contacts")), use_of(capacity.at("spare_nodes")), use_of(capacity.at("tracks")),
                    use_of(capacity.at("events"))};
    }
    s.compliance_condition = number(json.at("compliance_condition"));
    const Json& blur = json.at("mesh_blur_mm");
    s.mesh_blur = {number(blur.at("min")), number(blur.at("median")), number(blur.at("max")),
                   blur.at("nodes").get<int>()};
    for (const Json& m : json.value("mesh_changes", Json::array())) {
      const auto kind = word(m.at("kind").get<std::string>(), RemeshEvent::Kind::repositioned);
      const auto refused = word(m.at("not_moved_because").get<std::string>(), RemeshEvent::Refused::inverts);
      if (!kind || !refused) return refuse("a mesh change of unknown kind");
      s.mesh_changes.push_back({number(m.at("time_s")),
                                number(m.at("depth_mm")),
                                {.kind = *kind,
                                 .refused = *refused,
                                 .node = m.at("node").get<Index>(),
                                 .dimension = m.at("dimension").get<int>(),
                                 .elements = m.at("elements").get<int>(),
                                 .moved_mm = number(m.at("moved_mm")),
                                 .condition = number(m.at("condition"))}});
    }
    s.warnings = json.at("warnings").get<std::vector<std::string>>();
    return s;
  } catch (const Json::exception& e) {
    return refuse(e.what());
  }
}

}  // namespace stylet::results
