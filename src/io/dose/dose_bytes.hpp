// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/dose_io.hpp"

#include <string>

/// The bytes of the files that write_rtplan(), write_rtdose() and write_dose_nrrd() write.
/// @param where the file, for messages
namespace stylet {

Result<std::string> rtplan_bytes(const DosePlan& plan, const SourceModel& source, const std::string& where,
                                 const PatientRecord& patient);
Result<std::string> rtdose_bytes(const DoseGrid& grid, const std::string& plan_sop_instance, const std::string& where,
                                 const PatientRecord& patient, const std::string& comment);
Result<std::string> dose_nrrd_bytes(const DoseGrid& grid, const std::string& where);

}  // namespace stylet
