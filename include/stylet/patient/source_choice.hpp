// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_plan.hpp"
#include "stylet/dose/source_model.hpp"

#include <string>

namespace stylet {

/// The source model that the user names, or else the one that the plan names.
/// @param wanted name of a known model, or a JSON file; empty: the plan's own
/// Errors: nobody names a model (the message lists those that fit), an unknown name, the errors of the file.
Result<SourceModel> choose_source(const std::string& wanted, const DosePlan& plan);

}  // namespace stylet
