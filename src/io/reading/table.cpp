// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/table.hpp"

#include "detail/csv.hpp"
#include "detail/dicom.hpp"
#include "detail/parsers.hpp"
#include "dose/dose_parsers.hpp"
#include "mesh/raw_mesh.hpp"
#include "mesh/surfaces.hpp"
#include "reading/tasks.hpp"
#include "results/implant/stored_implant.hpp"
#include "results/stored_run.hpp"
#include "scenario/toml_document.hpp"

#include <stdexcept>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

Result<LabelImage> parse_mask(const fs::path& path, FileKind kind, int volume, const std::vector<std::string>& skip) {
  const MaskReadOptions options{.volume = volume, .skip = skip};
  switch (kind) {
    case FileKind::dicom:
      return parse_dicom_seg(path, options);
    case FileKind::nifti:
      return parse_nifti(path, options);
    case FileKind::nrrd:
      return parse_nrrd(path, options);
    case FileKind::metaimage:
      return parse_metaimage(path, options);
    default:
      throw std::logic_error("no mask");
  }
}

Result<RawMesh> parse_raw_mesh(const fs::path& path, FileKind kind) {
  switch (kind) {
    case FileKind::vtu:
    case FileKind::vtk_legacy:
      return parse_vtk_mesh(path, kind == FileKind::vtu);
    case FileKind::gmsh:
    case FileKind::medit:
      return parse_gmsh_mesh(path, kind == FileKind::medit);
    case FileKind::tetgen:
      return parse_tetgen_mesh(path);
    default:
      throw std::logic_error("no tetrahedral mesh");
  }
}

Result<MeshWithNotes> parse_tet_mesh(const fs::path& path, FileKind kind, double scale, const std::string& regions) {
  Result<RawMesh> raw = parse_raw_mesh(path, kind);
  if (!raw) return raw.error();
  return finish_mesh(std::move(*raw), path.string(), {.scale = scale, .regions_from = regions});
}

}  // namespace

TaskTable all_tasks() {
  TaskTable table;
  table.add(kOnlyPatient, only_patient_in);
  table.add(kIsSegmentation, [](const fs::path& path) -> Result<bool> { return is_dicom_seg(path); });
  table.add(kModality, [](const fs::path& path) -> Result<std::string> { return kind_of_dicom(path).modality; });
  table.add(kJsonFormat, format_of_json);
  table.add(kRtstruct, parse_rtstruct);
  table.add(kContourJson, parse_contour_json);
  table.add(kMask, parse_mask);
  table.add(kTetMesh, parse_tet_mesh);
  table.add(kSurfaces, [](const fs::path& path, FileKind kind, double scale) {
    return kind == FileKind::glb ? parse_glb(path, scale) : parse_surface(path, kind, scale);
  });
  table.add(kRtplan, parse_rtplan);
  table.add(kPlanText, parse_plan_text);
  table.add(kRtdose, parse_rtdose);
  table.add(kSourceModel, parse_source_model);
  table.add(kPatientRecord, parse_patient_record);
  table.add(kCsvLines, parse_csv_lines);
  table.add(kToml,
            [](const fs::path& source, const std::string& text) { return parse_toml_text(text, source.string()); });
  table.add(results::kRunFile, results::parse_run_file);
  table.add(results::kRunHeads, results::parse_run_heads);
  table.add(results::kImplantFile, results::parse_implant_file);
  table.add(results::kIsImplantFile, results::is_implant_file);
  return table;
}

}  // namespace stylet::detail
