// SPDX-License-Identifier: GPL-3.0-or-later
#include "messages.hpp"

#include "implant_text.hpp"
#include "stylet/io/hole_map_io.hpp"

#include "io/record/json.hpp"

#include <array>

namespace stylet::serve {

namespace {

using record::compact;
using record::Json;

constexpr std::array kStates{"loading", "ready", "failed"};

Parcel packed(wire::Kind kind, wire::Bytes bytes) {
  return {kind, std::make_shared<const wire::Bytes>(std::move(bytes))};
}

Parcel json_parcel(wire::Kind kind, const std::string& text) { return packed(kind, wire::encode(kind, text, 0)); }

Parcel json_parcel(wire::Kind kind, const Json& json) { return json_parcel(kind, compact(json)); }

Parcel parcel_of(const std::shared_ptr<const Scene>& scene) {
  return packed(wire::Kind::scene, wire::encode(*scene, 0));
}

Parcel parcel_of(const std::shared_ptr<const LiveDose>& dose) {
  return packed(wire::Kind::dose, wire::encode(*dose, 0));
}

Parcel parcel_of(const std::shared_ptr<const LiveImage>& image) {
  return packed(wire::Kind::image, wire::encode(*image, 0));
}

Parcel parcel_of(const ShownPlan& plan) { return json_parcel(wire::Kind::plan, plan_text(plan)); }

Parcel parcel_of(const LiveImplant& implant) { return json_parcel(wire::Kind::implant, implant_text(implant)); }

Parcel parcel_of(const LiveSeeds& seeds) { return json_parcel(wire::Kind::seeds, seeds_text(seeds)); }

Parcel parcel_of(const LiveMap& live) {
  return json_parcel(wire::Kind::map, Json{{"map", live.map ? Json::parse(hole_map_json(*live.map)) : Json(nullptr)},
                                           {"why_not", live.why_not},
                                           {"predicted", live.predicted},
                                           {"predicting", live.predicting}});
}

Parcel parcel_of(const LiveEvent& event) {
  return json_parcel(wire::Kind::event, Json{{"kind", event.kind},
                                             {"time_s", event.time_s},
                                             {"depth_mm", event.depth_mm},
                                             {"force_N", event.force_N},
                                             {"region", event.region},
                                             {"label", event.label}});
}

}  // namespace

Parcel as_parcel(const Message& message) {
  return std::visit(
      [](const auto& content) -> Parcel {
        using Content = std::decay_t<decltype(content)>;
        if constexpr (std::is_same_v<Content, std::shared_ptr<const LiveFrame>> || std::is_same_v<Content, Refusal>) {
          return {};
        } else {
          return parcel_of(content);
        }
      },
      message);
}

Parcel parcel_of(const Notice& notice) {
  return json_parcel(wire::Kind::notice, Json{{"text", notice.text}, {"cure", notice.cure}});
}

namespace {

Json interrupted_json(const std::optional<SessionStatus::Interrupted>& implant) {
  if (!implant) return nullptr;
  return {{"recording", implant->recording},
          {"recorded_s", implant->recorded_s},
          {"seeds", implant->seeds},
          {"planned_seeds", implant->planned_seeds},
          {"needle", implant->needle}};
}

}  // namespace

Parcel parcel_of(const SessionStatus& s, const OwnStatus& own) {
  return json_parcel(wire::Kind::status, Json{{"state", kStates.at(static_cast<std::size_t>(s.state))},
                                              {"stage", s.stage},
                                              {"fraction", s.fraction < 0.0 ? Json(nullptr) : Json(s.fraction)},
                                              {"message", s.failure.text},
                                              {"cure", s.failure.cure},
                                              {"mode", s.replay.name.empty() ? "live" : "replay"},
                                              {"paused", s.paused},
                                              {"insertion", s.insertion},
                                              {"hole", s.hole},
                                              {"inside", s.inside},
                                              {"seed_off_mm", s.seed_off_mm ? Json(*s.seed_off_mm) : Json(nullptr)},
                                              {"held", own.held},
                                              {"asking", own.asking},
                                              {"viewers", own.viewers},
                                              {"device", s.device},
                                              {"device_problem", s.device_problem},
                                              {"companion",
                                               {{"name", s.companion.name},
                                                {"not_used", s.companion.not_used},
                                                {"newest", s.companion.newest.text},
                                                {"cure", s.companion.newest.cure}}},
                                              {"image",
                                               {{"shown", s.image.shown},
                                                {"problem", s.image.problem},
                                                {"stage", s.image.stage},
                                                {"probe_device", s.image.probe_device},
                                                {"probe_problem", s.image.probe_problem}}},
                                              {"recording",
                                               {{"name", s.recording.name},
                                                {"seconds", s.recording.seconds},
                                                {"problem", s.recording.problem},
                                                {"warning", s.recording.warning}}},
                                              {"replay",
                                               {{"name", s.replay.name},
                                                {"time_s", s.replay.time_s},
                                                {"duration_s", s.replay.duration_s},
                                                {"playing", s.replay.rate > 0.0},
                                                {"rate", s.replay.rate}}},
                                              {"interrupted", interrupted_json(s.interrupted)},
                                              {"loop",
                                               {{"steps", s.loop.steps},
                                                {"missed", s.loop.missed},
                                                {"p50_us", s.loop.p50_us},
                                                {"p99_us", s.loop.p99_us},
                                                {"max_us", s.loop.max_us},
                                                {"rights", s.loop.rights}}},
                                              {"you_hold", own.you_hold},
                                              {"you_ask", own.you_ask},
                                              {"hand_stopped", own.hand_stopped},
                                              {"lag_s", own.lag_s ? Json(*own.lag_s) : Json(nullptr)},
                                              {"dropped_messages", own.dropped_messages},
                                              {"skipped_frames", own.skipped_frames}});
}

}  // namespace stylet::serve
