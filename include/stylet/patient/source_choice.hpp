// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_plan.hpp"
#include "stylet/dose/source_model.hpp"

#include <string>
#include <vector>

namespace stylet {

/// The source models of all kinds of source of a plan: those that the user names, or else those that the plan names.
/// @param wanted names of known models, or JSON files; "ID=NAME" for one kind of source, where ID is its number in a
/// DICOM plan (300A,0212), its name in a text plan, or its isotope; a name alone is for all other kinds
/// @return (kind_count(plan)) models
/// Errors: nobody names a model for a kind (the message lists those that fit), an unknown name or ID, two names for one
/// kind, the errors of the file.
Result<std::vector<SourceModel>> choose_sources(const std::vector<std::string>& wanted, const DosePlan& plan);

}  // namespace stylet
