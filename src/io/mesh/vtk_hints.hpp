// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

class vtkDataObject;

namespace stylet::detail {

/// Frame and unit according to the metadata of a VTK file.
struct VtkHints {
  bool ras = false;      ///< coordinates are RAS; otherwise LPS
  double unit_mm = 0.0;  ///< [mm] per file unit; 0 if not stated
};

/// Reads the text "SPACE=RAS" in a header line, as 3D Slicer writes it, and the field data "SPACE" and "UNITS".
VtkHints vtk_hints(vtkDataObject& data, const std::string& header);

}  // namespace stylet::detail
