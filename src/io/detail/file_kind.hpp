// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>

namespace stylet::detail {

enum class FileKind {
  dicom,
  contour_json,
  nifti,
  nrrd,
  metaimage,
  vtu,
  vtk_legacy,
  gmsh,
  medit,
  tetgen,
  stl,
  ply,
  obj,
  vtp,
  glb,
  unknown,
};

/// What a user calls such a file, e.g. "a NIfTI image".
std::string name_of(FileKind kind);

/// Sentence that lists every format Stylet reads; part of messages.
std::string readable_formats();

/// Recognises a file by its first bytes, and by its extension only where the content has no mark of its own (OBJ,
/// TetGen, binary STL). Errors: nothing there, a folder, not a regular file, no permission, empty.
Result<FileKind> identify(const std::filesystem::path& path);

}  // namespace stylet::detail
