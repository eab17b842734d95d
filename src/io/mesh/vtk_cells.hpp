// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

class vtkCellArray;

namespace stylet::detail {

/// Whether each cell is a part of the array's list of nodes. The readers of VTK take from a file as it is where a cell
/// begins, or find it from numbers of nodes that may be negative.
bool cells_are_whole(vtkCellArray* cells);

}  // namespace stylet::detail
