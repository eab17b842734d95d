// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/dose_grid.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/dose/goals.hpp"
#include "stylet/dose/patient_record.hpp"
#include "stylet/dose/source_model.hpp"

#include <filesystem>
#include <vector>

namespace stylet {

/// Kind of a file of brachytherapy, as its first bytes and its header tell it.
enum class DoseFileKind { plan, dose_grid, source_model, none };

/// Recognises plans (DICOM RTPLAN, plan JSON, seed CSV), dose grids (DICOM RTDOSE) and source models (source JSON).
/// A file that cannot be opened is `none`: readers give the error.
DoseFileKind dose_file_kind(const std::filesystem::path& path);

/// Reads a plan: DICOM RTPLAN (LDR, HDR, PDR), plan JSON, or CSV of seeds (docs/formats.md). Strengths and places are
/// checked; notes say what the reader decided where real files disagree with the standard.
Result<DosePlan> read_plan(const std::filesystem::path& path);

/// Writes a DICOM RTPLAN. On error no incomplete file is left.
/// @param source the source model that was used, for isotope, half-life and lengths
/// @param patient whose plan it is; what it does not say is empty in the file
Result<> write_rtplan(const DosePlan& plan, const SourceModel& source, const std::filesystem::path& path,
                      const PatientRecord& patient = {});

/// Writes plan JSON (docs/formats.md) with points and axes.
Result<> write_plan_json(const DosePlan& plan, const std::filesystem::path& path);

/// Reads a DICOM RTDOSE. Doses in CGY are converted; relative doses are an error.
Result<DoseGrid> read_rtdose(const std::filesystem::path& path);

/// Writes a DICOM RTDOSE with 32 bits for each dose.
/// @param plan_sop_instance UID of the plan to which the dose belongs; may be empty
/// @param patient whose dose it is; what it does not say is empty in the file
/// @param comment what the doses mean, such as "total dose until the sources have decayed"; may be empty
Result<> write_rtdose(const DoseGrid& grid, const std::string& plan_sop_instance, const std::filesystem::path& path,
                      const PatientRecord& patient = {}, const std::string& comment = {});

/// Writes a dose grid as NRRD, space left-posterior-superior.
Result<> write_dose_nrrd(const DoseGrid& grid, const std::filesystem::path& path);

/// The record that the DICOM files of a plan have in common: where `patient` has no frame of reference it is the
/// plan's, and a study or frame that nobody names is derived from the plan's content.
PatientRecord record_of_files(PatientRecord patient, const DosePlan& plan, const SourceModel& source);

/// The SOP instance UID that write_rtplan() gives a plan: it follows from the file's content.
std::string rtplan_uid(const DosePlan& plan, const SourceModel& source, const PatientRecord& patient = {});

/// Reads a source model from JSON (docs/formats.md). Errors: those of the format and of check_source().
Result<SourceModel> read_source_model(const std::filesystem::path& path);

/// Reads points from CSV with the columns x_mm, y_mm, z_mm.
Result<std::vector<Vec3>> read_points(const std::filesystem::path& path);

/// Reads goals from CSV with the columns structure, metric, bound (such as ">=90" or "<150") and citation.
Result<std::vector<DoseGoal>> read_goals(const std::filesystem::path& path);

}  // namespace stylet
