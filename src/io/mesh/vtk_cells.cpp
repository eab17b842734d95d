// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/vtk_cells.hpp"

#include <vtkCellArray.h>
#include <vtkDataArray.h>

namespace stylet::detail {

bool cells_are_whole(vtkCellArray* cells) {
  if (cells == nullptr) return true;
  vtkDataArray& begins = *cells->GetOffsetsArray();  // and behind them the end of the last cell
  double last = 0.0;
  for (vtkIdType c = 0; c < begins.GetNumberOfTuples(); ++c) {
    const double begin = begins.GetComponent(c, 0);
    if (begin < last) return false;
    last = begin;
  }
  return last <= static_cast<double>(cells->GetNumberOfConnectivityIds());
}

}  // namespace stylet::detail
