// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/input.hpp"

#include "detail/file_kind.hpp"
#include "reading/ask.hpp"
#include "reading/tasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace stylet {

namespace fs = std::filesystem;
using detail::FileKind;

namespace {

template <class T>
Result<PatientInput> as_input(Result<T> read) {
  if (!read) return read.error();
  return PatientInput(std::move(*read));
}

}  // namespace

Result<PatientInput> read_input(const fs::path& path, const MeshReadOptions& mesh_options,
                                const MaskReadOptions& mask_options, std::span<const std::string> skip) {
  std::error_code code;
  if (fs::is_directory(path, code)) {
    const Result<std::string> found = detail::ask(detail::kOnlyPatient, path);
    return found ? read_input(*found, mesh_options, mask_options, skip) : Result<PatientInput>(found.error());
  }
  MaskReadOptions of_mask = mask_options;
  of_mask.skip.insert(of_mask.skip.end(), skip.begin(), skip.end());
  Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  bool is_mask = *kind == FileKind::nifti || *kind == FileKind::nrrd || *kind == FileKind::metaimage;
  if (*kind == FileKind::dicom) {
    const Result<bool> segmentation = detail::ask(detail::kIsSegmentation, path);
    if (!segmentation) return segmentation.error();
    is_mask = *segmentation;
  }
  const bool in_mm = is_mask || *kind == FileKind::dicom || *kind == FileKind::contour_json;
  if (mesh_options.scale > 0.0 && in_mm) {
    return input_error(path.string(),
                       fmt::format("--scale or patient.scale has no meaning for {}, whose coordinates are in mm by "
                                   "definition",
                                   is_mask ? "a mask" : "contours"),
                       "Leave it out; if the coordinates are in another unit, convert the file");
  }
  if (mask_options.volume > 0 && !is_mask) {
    return input_error(path.string(),
                       fmt::format("this is {}; only a mask has volumes to choose from", detail::name_of(*kind)),
                       "Leave the volume out (patient.volume, --volume)");
  }
  constexpr std::array meshes{FileKind::vtu, FileKind::vtk_legacy, FileKind::gmsh, FileKind::medit, FileKind::tetgen};
  if (!mesh_options.regions_from.empty() && *kind != FileKind::unknown &&
      std::find(meshes.begin(), meshes.end(), *kind) == meshes.end()) {
    return input_error(path.string(),
                       fmt::format("this is {}; only a tetrahedral mesh has arrays ('{}') that can be its regions",
                                   detail::name_of(*kind), mesh_options.regions_from),
                       "Leave out --regions-from or patient.regions_from");
  }
  switch (*kind) {
    case FileKind::dicom:
      return is_mask ? as_input(read_label_image(path, of_mask)) : as_input(read_rtstruct(path, skip));
    case FileKind::contour_json:
      return as_input(read_contour_json(path, skip));
    case FileKind::nifti:
    case FileKind::nrrd:
    case FileKind::metaimage:
      return as_input(read_label_image(path, of_mask));
    case FileKind::vtu:
    case FileKind::vtk_legacy:
    case FileKind::gmsh:
    case FileKind::medit:
    case FileKind::tetgen:
      return as_input(read_tet_mesh(path, mesh_options));
    case FileKind::stl:
    case FileKind::ply:
    case FileKind::obj:
    case FileKind::vtp:
    case FileKind::glb:
      return as_input(read_surfaces(path, mesh_options));
    case FileKind::unknown:
      break;
  }
  if (path.extension() == ".toml") {
    return input_error(path.string(), "this is a scenario (TOML) by its name, and a patient's file is expected",
                       "Run it with stylet insert, or give the file that it names as source below [patient]");
  }
  return input_error(path.string(), "the format is not recognised", detail::readable_formats());
}

}  // namespace stylet
