// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/file_kind.hpp"
#include "detail/wire.hpp"
#include "dose/source_wire.hpp"
#include "reading/task.hpp"

#include <string>
#include <vector>

/// The tasks of the reading program that need libraries of formats; those of text and CSV are beside their readers
/// (scenario/toml_document.hpp, detail/csv.hpp), as are those of recordings (results/stored_run.hpp,
/// results/implant/stored_implant.hpp). Each is named after its parser.
namespace stylet::detail {

inline constexpr Task<std::string> kOnlyPatient{"only_patient_in"};
inline constexpr Task<bool> kIsSegmentation{"is_dicom_seg"};
inline constexpr Task<std::string> kModality{"modality_of_dicom"};
inline constexpr Task<std::string> kJsonFormat{"format_of_json"};

inline constexpr Task<ContourSet, std::vector<std::string>> kRtstruct{"parse_rtstruct"};
inline constexpr Task<ContourSet, std::vector<std::string>> kContourJson{"parse_contour_json"};
/// Arguments: kind of the file, number of the volume, segments to skip.
inline constexpr Task<LabelImage, FileKind, int, std::vector<std::string>> kMask{"parse_mask"};
/// Arguments: kind of the file, length of its unit [mm], array of the regions.
inline constexpr Task<MeshWithNotes, FileKind, double, std::string> kTetMesh{"parse_tet_mesh"};
/// Arguments: kind of the file, length of its unit [mm].
inline constexpr Task<SurfacesWithNotes, FileKind, double> kSurfaces{"parse_surfaces"};

inline constexpr Task<DosePlan> kRtplan{"parse_rtplan"};
inline constexpr Task<DosePlan> kPlanText{"parse_plan_text"};
inline constexpr Task<DoseGrid> kRtdose{"parse_rtdose"};
inline constexpr Task<SourceModel> kSourceModel{"parse_source_model"};
inline constexpr Task<FoundPatient> kPatientRecord{"parse_patient_record"};

}  // namespace stylet::detail
