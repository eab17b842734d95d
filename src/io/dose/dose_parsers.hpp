// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/dose_io.hpp"
#include "stylet/io/patient_record_io.hpp"

/// The parsers behind the readers of dose_io.hpp and patient_record_io.hpp, to be called in the reading program only
/// (reading/ask.hpp).
namespace stylet::detail {

Result<DosePlan> parse_rtplan(const std::filesystem::path& path);
Result<DosePlan> parse_plan_text(const std::filesystem::path& path);
/// The value of "format" of a JSON file; empty if it has none.
Result<std::string> format_of_json(const std::filesystem::path& path);
Result<SourceModel> parse_source_model(const std::filesystem::path& path);
Result<FoundPatient> parse_patient_record(const std::filesystem::path& path);
Result<DoseGrid> parse_rtdose(const std::filesystem::path& path);

}  // namespace stylet::detail
