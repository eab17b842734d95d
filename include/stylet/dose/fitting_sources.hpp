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

/// The isotope of a kind of source: by its name, or where that is none (in files without identities, for example), by
/// the half-life. Empty: unknown.
std::string isotope_of(const SourceKind& kind);

/// Whether the length of a kind of source, where the plan gives one, is that of a model's active part or capsule within
/// 0.5 mm.
bool fits_length(const SourceKind& kind, const SourceModel& source);

/// The known source models that fit what a plan says about a kind of source: the isotope (isotope_of()), and the
/// length. Models of another length are left out only if one with the right length exists. All models, where the plan
/// says nothing.
std::vector<SourceModel> fitting_sources(const SourceKind& kind);
/// Those of the plan's first kind.
std::vector<SourceModel> fitting_sources(const DosePlan& plan);

/// The error for a plan whose source model nobody has named: it lists the models that fit.
/// @param number of the kind of source
Error unnamed_source(const DosePlan& plan, std::size_t number = 0);

}  // namespace stylet
