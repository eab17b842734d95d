// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/compliance_supply.hpp"

#include <vector>

namespace stylet {

/// The parcel that the two sides of a ComplianceSupply pass back and forth. Each side puts into it the memory that it
/// no longer needs, so that the step frees none.
struct SupplyParcel {
  /// A slot of the store that the worker requests.
  struct Leaver {
    Index node = -1;
    Index slot = -1;
    bool left = false;                              ///< the step's answer: whether the slot was given up
    ComplianceRow row;                              ///< previous contents of the slot, to be freed by the worker
    std::shared_ptr<const MeshKernel::Row> kernel;  ///< previous row of the node in the mesh kernel, to be freed by the
                                                    ///< worker
  };
  /// A new row for a node in the mesh kernel.
  struct KernelRow {
    Index node = -1;
    std::shared_ptr<const MeshKernel::Row> row;
  };
  NeedleWhereabouts needle;            ///< written by the step
  unsigned call = 0;                   ///< number of the last call that the step had made
  std::vector<Leaver> leavers;         ///< requested by the worker, answered by the step
  std::vector<ComplianceRow> rows;     ///< rows for the store, made by the worker
  std::vector<KernelRow> kernel_rows;  ///< rows for the mesh kernel, made by the worker

  /// Empties the lists of both sides.
  void clear() {
    leavers.clear();
    rows.clear();
    kernel_rows.clear();
  }
};

}  // namespace stylet
