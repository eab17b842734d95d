// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/source_model.hpp"

#include <span>

namespace stylet {

/// The source models that the program has: I-125 (6711, selectSeed, AgX100, Best 2301), Pd-103 (TheraSeed 200), Cs-131
/// (CS-1 Rev2), Ir-192 (GammaMed Plus, Flexisource, mHDR-v1, mHDR-v2). Each has the citation of its data.
[[nodiscard]] std::span<const SourceModel> known_sources();

/// The source model with this name. Error: no source has this name; the message names the nearest one, or all of them.
Result<SourceModel> find_source(const std::string& name);

}  // namespace stylet
