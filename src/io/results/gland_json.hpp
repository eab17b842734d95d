// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/gland_motion.hpp"

#include <nlohmann/json.hpp>

#include <optional>

namespace stylet::results {

/// The key `gland` of summary.json (docs/results.md); null without a target.
nlohmann::ordered_json gland_json(const std::optional<GlandMotion>& gland);

/// What gland_json() made. Throws nlohmann's exceptions where it is something else.
std::optional<GlandMotion> gland_of(const nlohmann::ordered_json& json);

}  // namespace stylet::results
