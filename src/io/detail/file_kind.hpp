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

/// The name of a kind of file in messages, e.g. "a NIfTI image".
std::string name_of(FileKind kind);

/// A sentence for messages that lists every format that Stylet reads.
std::string readable_formats();

/// Recognises the format of a file by its first bytes; by its extension only for formats without a mark in their
/// content (OBJ, TetGen, binary STL). Errors: nothing there, a folder, not a regular file, no permission, empty.
Result<FileKind> identify(const std::filesystem::path& path);

}  // namespace stylet::detail
