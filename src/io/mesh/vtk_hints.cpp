// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/vtk_hints.hpp"

#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkStringArray.h>

namespace stylet::detail {

namespace {

std::string field_text(vtkDataObject& data, const char* name) {
  auto* array = vtkStringArray::SafeDownCast(data.GetFieldData()->GetAbstractArray(name));
  return array != nullptr && array->GetNumberOfValues() > 0 ? std::string(array->GetValue(0)) : std::string();
}

}  // namespace

VtkHints vtk_hints(vtkDataObject& data, const std::string& header) {
  VtkHints hints;
  hints.ras = header.find("SPACE=RAS") != std::string::npos || field_text(data, "SPACE") == "RAS";
  const std::string unit = field_text(data, "UNITS");
  if (unit == "mm") hints.unit_mm = 1.0;
  if (unit == "m") hints.unit_mm = 1000.0;
  return hints;
}

}  // namespace stylet::detail
