// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/node_slots.hpp"
#include "stylet/fem/tissue.hpp"

#include <memory>
#include <span>

namespace stylet {

/// Blocks of K⁻¹ between a node and those that had slots before it. Never changed once made, so copies share it.
struct ComplianceRow {
  Index node = -1;
  Index slot = -1;                         ///< which the node is to have
  Index length = 0;                        ///< slots the row reaches
  std::shared_ptr<const double[]> blocks;  ///< [mm/N] (3×3 for each slot) column by column: displacement of the node
                                           ///< per force on the slot's node; zero for slots that were free
};

/// Rows of free nodes that have no slots yet, each with the blocks to all that are stored and to those of `nodes`
/// before it. Solves with the tissue's factor, in batches; const, so any thread may. The block of a node with itself is
/// symmetric to the last bit.
/// @param stored who has which slot now
/// @param nodes displacement nodes that can move
/// @param slots (nodes) free ones, which they are to have
std::vector<ComplianceRow> solve_rows(const Tissue& tissue, const NodeSlots& stored, std::span<const Index> nodes,
                                      std::span<const Index> slots, const Progress& progress = {});

}  // namespace stylet
