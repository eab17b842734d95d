// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

class vtkDataObject;

namespace stylet::detail {

/// What a VTK file says about its frame and unit beside the geometry.
struct VtkHints {
  bool ras = false;      ///< coordinates are RAS; otherwise LPS
  double unit_mm = 0.0;  ///< [mm] per file unit, 0 when not stated
};

/// Looks for the words "SPACE=RAS" in a header line, as 3D Slicer writes them, and for the field data "SPACE" and
/// "UNITS".
VtkHints vtk_hints(vtkDataObject& data, const std::string& header);

}  // namespace stylet::detail
