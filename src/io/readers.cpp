// SPDX-License-Identifier: GPL-3.0-or-later
// The public readers: look at what the file is, then let the right parser work on it in a child process.
#include "detail/file_kind.hpp"
#include "detail/guard.hpp"
#include "detail/parsers.hpp"

#include <fmt/format.h>

namespace stylet {

namespace fs = std::filesystem;
using detail::FileKind;
using detail::guarded;

namespace {

/// Refusal of a file that is something else than what was asked for.
Error wrong_kind(const fs::path& path, FileKind found, const char* wanted) {
  return input_error(path.string(), fmt::format("this is {}, {} is expected", detail::name_of(found), wanted),
                     detail::readable_formats());
}

}  // namespace

Result<ContourSet> read_rtstruct(const fs::path& path) {
  std::error_code code;
  if (!fs::is_directory(path, code)) {
    Result<FileKind> kind = detail::identify(path);
    if (!kind) return kind.error();
    if (*kind != FileKind::dicom) return wrong_kind(path, *kind, "a DICOM RT Structure Set");
  }
  return guarded<ContourSet>(path, [&] { return detail::parse_rtstruct(path); });
}

Result<ContourSet> read_contour_json(const fs::path& path) {
  Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  if (*kind != FileKind::contour_json) return wrong_kind(path, *kind, "a contour JSON file");
  return guarded<ContourSet>(path, [&] { return detail::parse_contour_json(path); });
}

Result<LabelImage> read_label_image(const fs::path& path) {
  Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  switch (*kind) {
    case FileKind::nifti:
      return guarded<LabelImage>(path, [&] { return detail::parse_nifti(path); });
    case FileKind::nrrd:
      return guarded<LabelImage>(path, [&] { return detail::parse_nrrd(path); });
    case FileKind::metaimage:
      return guarded<LabelImage>(path, [&] { return detail::parse_metaimage(path); });
    default:
      return wrong_kind(path, *kind, "a label mask (NIfTI, NRRD, MetaImage)");
  }
}

}  // namespace stylet
