// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/compliance_supply.hpp"

#include <vector>

namespace stylet {

/// What step and worker of a ComplianceSupply pass to and fro. Whatever one side does not need any more travels to the
/// other in it, so that the step frees no memory.
struct SupplyParcel {
  /// A slot of the store that the worker would like to have.
  struct Leaver {
    Index node = -1;
    Index slot = -1;
    bool left = false;                              ///< the step's answer: whether it gave the slot up
    ComplianceRow row;                              ///< what was in the slot, to be freed
    std::shared_ptr<const MeshKernel::Row> kernel;  ///< what the near field had of the node, to be freed
  };
  /// What the near field is to have of a node.
  struct KernelRow {
    Index node = -1;
    std::shared_ptr<const MeshKernel::Row> row;
  };
  NeedleWhereabouts needle;            ///< written by the step
  unsigned call = 0;                   ///< number of the last call for work that the step knew of
  std::vector<Leaver> leavers;         ///< written by the worker, answered by the step
  std::vector<ComplianceRow> rows;     ///< made by the worker, for the store
  std::vector<KernelRow> kernel_rows;  ///< made by the worker, for the near field

  /// Takes everything out that one side made for the other.
  void clear() {
    leavers.clear();
    rows.clear();
    kernel_rows.clear();
  }
};

}  // namespace stylet
