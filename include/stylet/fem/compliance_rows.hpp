// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/node_slots.hpp"
#include "stylet/fem/tissue.hpp"

#include <memory>
#include <span>

namespace stylet {

/// One row of a ComplianceStore: the blocks of K⁻¹ between a node and the nodes that got their slots before it. A row
/// is never changed after it was made, so copies of a store share it.
struct ComplianceRow {
  Index node = -1;
  Index slot = -1;                         ///< the slot reserved for the node
  Index length = 0;                        ///< number of slots that the row covers
  std::shared_ptr<const double[]> blocks;  ///< [mm/N] (length) 3×3 blocks, column-major: displacement of `node` per
                                           ///< force on the slot's node; zero for slots that were free
};

/// Computes rows for nodes that have no slot yet. Each row has the blocks with all stored nodes and with the nodes
/// before it in `nodes`. Solves with the tissue's factor, in batches; reads only, so it may run in any thread. The
/// block of a node with itself is symmetric to the last bit.
/// @param stored current assignment of nodes to slots
/// @param nodes displacement nodes that are not fixed
/// @param slots (nodes) free slots to be assigned to these nodes
std::vector<ComplianceRow> solve_rows(const Tissue& tissue, const NodeSlots& stored, std::span<const Index> nodes,
                                      std::span<const Index> slots, const Progress& progress = {});

}  // namespace stylet
