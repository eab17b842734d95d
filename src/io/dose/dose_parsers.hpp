// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/dose_io.hpp"

/// The parsers behind the readers of dose_io.hpp. Those of DICOM files give untrusted bytes to third-party code and
/// must only be called in a child process (detail/guard.hpp).
namespace stylet::detail {

Result<DosePlan> parse_rtplan(const std::filesystem::path& path);
Result<DosePlan> parse_plan_text(const std::filesystem::path& path);
Result<DoseGrid> parse_rtdose(const std::filesystem::path& path);

}  // namespace stylet::detail
