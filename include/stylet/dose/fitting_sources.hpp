// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_plan.hpp"
#include "stylet/dose/source_model.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stylet {

/// An isotope's name in one form: "I-125" for "I125", "125I", "Iodine-125" or "i 125". Text that is none stays.
std::string isotope_name(std::string_view text);

/// The known source models that fit what a plan says about its sources: the isotope (by its half-life where the plan
/// does not name it), and the length of the active part
/// within 0.5 mm where a plan gives one. Models of another length are left out only if one with the right length
/// exists. All models, where the plan says nothing.
std::vector<SourceModel> fitting_sources(const DosePlan& plan);

/// The error for a plan whose source model nobody has named: it lists the models that fit.
Error unnamed_source(const DosePlan& plan);

/// Checks that a source model can be that of a plan. Error: the plan has another isotope.
/// @return sentences for the user: half-lives or lengths that differ
Result<std::vector<std::string>> compare_source(const DosePlan& plan, const SourceModel& source);

}  // namespace stylet
