// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/gland_motion.hpp"

#include <nlohmann/json.hpp>

#include <optional>

namespace stylet::results {

/// LR, AP, SI and norm of a vector [mm]; null where there is none or it is not finite.
nlohmann::ordered_json vector_json(const std::optional<Vec3>& v);

/// The vector that vector_json() wrote. Throws nlohmann's exceptions where it is something else.
std::optional<Vec3> vector_of(const nlohmann::ordered_json& json);

/// The key `gland` of summary.json (docs/results.md); null without a target.
nlohmann::ordered_json gland_json(const std::optional<GlandMotion>& gland);

/// What gland_json() made. Throws nlohmann's exceptions where it is something else.
std::optional<GlandMotion> gland_of(const nlohmann::ordered_json& json);

}  // namespace stylet::results
