// SPDX-License-Identifier: GPL-3.0-or-later
// The public readers: they identify the format of the file and have the reading program parse it.
#include "detail/file_kind.hpp"
#include "detail/reach.hpp"
#include "mesh/raw_mesh.hpp"
#include "reading/ask.hpp"
#include "reading/tasks.hpp"
#include "stylet/core/printable.hpp"
#include "stylet/geom/structure_names.hpp"
#include "stylet/io/contours_io.hpp"
#include "stylet/io/label_image_io.hpp"

#include <fmt/format.h>

namespace stylet {

namespace fs = std::filesystem;
using detail::FileKind;

namespace {

/// The error for a file of another kind than expected.
Error wrong_kind(const fs::path& path, FileKind found, const char* wanted) {
  return input_error(path.string(), fmt::format("this is {}, {} is expected", detail::name_of(found), wanted),
                     detail::readable_formats());
}

/// Error if a point of the structure is out of reach (detail/reach.hpp).
Result<> check_reach(const ContourSet& set, const Roi& roi) {
  for (std::size_t c = 0; c < roi.contours.size(); ++c) {
    const std::vector<Vec3>& points = roi.contours[c].points;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (detail::is_in_reach(points[p])) continue;
      Error error = detail::check_reach(fmt::format("{}, ROI '{}', contour {}", set.source, roi.name, c + 1), points[p],
                                        fmt::format("point {}", p + 1))
                        .error();
      error.cure += or_skip(roi.name);
      return error;
    }
  }
  return Ok{};
}

/// Notes quote names of the file.
void make_printable(std::vector<std::string>& notes) {
  for (std::string& note : notes) note = with_short_quotes(printable(note));
}

/// Makes the names of labels safe to show.
Result<LabelImage> with_printable_names(Result<LabelImage> read) {
  if (!read) return read;
  for (auto& [label, name] : read->names) name = printable_name(name);
  for (auto& [label, meaning] : read->meanings) meaning = printable_name(meaning);
  make_printable(read->notes);
  return read;
}

/// Makes the names safe to show and checks the reach of all structures, for every format. A structure in `skip` that is
/// out of reach is left out instead.
Result<ContourSet> within_reach(Result<ContourSet> read, std::span<const std::string> skip) {
  if (!read) return read;
  read->label = printable_name(read->label);
  for (Roi& roi : read->rois) roi.name = printable_name(roi.name);
  for (PassedOver& structure : read->passed_over) structure.name = printable_name(structure.name);
  make_printable(read->notes);
  std::vector<Roi> in_reach;
  for (Roi& roi : read->rois) {
    const Result<> reach = check_reach(*read, roi);
    if (reach) {
      in_reach.push_back(std::move(roi));
    } else if (is_listed(roi.name, skip)) {
      read->passed_over.push_back({roi.name, "damaged, and named in [patient] skip"});
    } else {
      return reach.error();
    }
  }
  read->rois = std::move(in_reach);
  return read;
}

}  // namespace

Result<ContourSet> read_rtstruct(const fs::path& path, std::span<const std::string> skip) {
  std::error_code code;
  fs::path file = path;
  if (fs::is_directory(path, code)) {
    const Result<std::string> found = detail::ask(detail::kOnlyPatient, path);
    if (!found) return found.error();
    file = *found;
  }
  Result<FileKind> kind = detail::identify(file);
  if (!kind) return kind.error();
  if (*kind != FileKind::dicom) return wrong_kind(file, *kind, "a DICOM RT Structure Set");
  return within_reach(detail::ask(detail::kRtstruct, file, {skip.begin(), skip.end()}), skip);
}

Result<ContourSet> read_contour_json(const fs::path& path, std::span<const std::string> skip) {
  Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  if (*kind != FileKind::contour_json) return wrong_kind(path, *kind, "a contour JSON file");
  return within_reach(detail::ask(detail::kContourJson, path, {skip.begin(), skip.end()}), skip);
}

Result<LabelImage> read_label_image(const fs::path& path, const MaskReadOptions& options) {
  Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  switch (*kind) {
    case FileKind::dicom:
    case FileKind::nifti:
    case FileKind::nrrd:
    case FileKind::metaimage:
      return with_printable_names(detail::ask(detail::kMask, path, *kind, options.volume, options.skip));
    default:
      return wrong_kind(path, *kind, "a label mask (NIfTI, NRRD, MetaImage, DICOM SEG)");
  }
}

Result<TetMesh> read_tet_mesh(const fs::path& path, const MeshReadOptions& options) {
  using detail::MeshWithNotes;
  if (Result<> good = detail::check_scale(options.scale); !good) return good.error();
  Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  switch (*kind) {
    case FileKind::vtu:
    case FileKind::vtk_legacy:
    case FileKind::gmsh:
    case FileKind::medit:
    case FileKind::tetgen:
      break;
    default:
      return wrong_kind(path, *kind, "a tetrahedral mesh (VTU, VTK, gmsh, MEDIT, TetGen)");
  }
  Result<MeshWithNotes> read = detail::ask(detail::kTetMesh, path, *kind, options.scale, options.regions_from);
  if (!read) return read.error();
  make_printable(read->notes);
  if (options.notes != nullptr) options.notes->insert(options.notes->end(), read->notes.begin(), read->notes.end());
  return std::move(read->mesh);
}

Result<std::vector<Surface>> read_surfaces(const fs::path& path, const MeshReadOptions& options) {
  using detail::SurfacesWithNotes;
  if (Result<> good = detail::check_scale(options.scale); !good) return good.error();
  Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  switch (*kind) {
    case FileKind::stl:
    case FileKind::ply:
    case FileKind::obj:
    case FileKind::vtp:
    case FileKind::glb:
      break;
    default:
      return wrong_kind(path, *kind, "a triangulated surface (STL, PLY, OBJ, VTP, GLB)");
  }
  Result<SurfacesWithNotes> read = detail::ask(detail::kSurfaces, path, *kind, options.scale);
  if (!read) return read.error();
  for (Surface& surface : read->surfaces) surface.name = printable_name(surface.name);
  make_printable(read->notes);
  if (options.notes != nullptr) options.notes->insert(options.notes->end(), read->notes.begin(), read->notes.end());
  return std::move(read->surfaces);
}

}  // namespace stylet
