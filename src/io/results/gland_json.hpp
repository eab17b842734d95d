// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <nlohmann/json.hpp>

#include <optional>

namespace stylet::results {

/// JSON with LR, AP, SI and norm of a vector [mm]; null if it is empty or not finite.
nlohmann::ordered_json vector_json(const std::optional<Vec3>& v);

/// Reads the JSON of vector_json(). Throws nlohmann's exceptions if it is something else.
std::optional<Vec3> vector_of(const nlohmann::ordered_json& json);

/// The value of the key `in_place` of summary.json and of a hole of a map (docs/results.md).
nlohmann::ordered_json in_place_json(const NeedlesInPlace& in_place);

/// Reads the JSON of in_place_json(). Throws nlohmann's exceptions if it is something else.
NeedlesInPlace in_place_of(const nlohmann::ordered_json& json);

/// The value of the key `gland` of summary.json (docs/results.md); null without a target.
nlohmann::ordered_json gland_json(const std::optional<GlandMotion>& gland);

/// Reads the JSON of gland_json(). Throws nlohmann's exceptions if it is something else.
std::optional<GlandMotion> gland_of(const nlohmann::ordered_json& json);

}  // namespace stylet::results
