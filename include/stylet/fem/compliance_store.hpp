// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/compliance_rows.hpp"

#include <cassert>

namespace stylet {

/// Blocks of K⁻¹ between the nodes near the needle. Rows are computed from the factor before the loop needs them;
/// reading neither allocates nor solves. A row is never changed, so a copy of a store shares its rows and grows on its
/// own. Of two nodes the row that came later holds their block.
class ComplianceStore {
 public:
  explicit ComplianceStore(std::shared_ptr<const Tissue> tissue);

  /// The blocks among the tissue's corridor(), known from elsewhere.
  /// @param blocks [mm/N] (3c × 3c) as Tissue::compliance_of_corridor() gives them
  ComplianceStore(std::shared_ptr<const Tissue> tissue, const MatX& blocks);

  /// Makes all blocks among `nodes` and those stored before available, and those of the nodes that the kind of element
  /// adds between two of them. Solves in batches; one call for many nodes costs less than many calls. Numbers outside
  /// the mesh are passed over. Not for the step.
  /// @param nodes of the mesh
  void add_nodes(std::span<const Index> nodes, const Progress& progress = {});

  /// True when the node's blocks are stored. Fixed nodes always count as stored: their compliance is zero.
  [[nodiscard]] bool has(Index node) const { return slots_.has(node) || tissue_->is_fixed(node); }

  /// K⁻¹ block between nodes a and b [mm/N] (3×3): displacement of a per force on b. Both must be stored.
  [[nodiscard]] Mat3 block(Index a, Index b) const {
    assert(has(a) && has(b));
    const Index at = slots_.slot(a);
    const Index on = slots_.slot(b);
    if (at < 0 || on < 0) return Mat3::Zero();
    const Row& row = rows_[static_cast<std::size_t>(at)];
    const Row& other = rows_[static_cast<std::size_t>(on)];
    if (row.order >= other.order) return Eigen::Map<const Mat3>(row.blocks.get() + 9 * std::ptrdiff_t{on});
    return Eigen::Map<const Mat3>(other.blocks.get() + 9 * std::ptrdiff_t{at}).transpose();
  }

  /// All blocks (3 nodes × 3 nodes) [mm/N], in the order of stored(). Allocates.
  [[nodiscard]] MatX blocks() const;
  /// Nodes whose blocks are stored, by slot.
  [[nodiscard]] std::vector<Index> stored() const;

  /// Makes free slots at the end, for take(). Allocates.
  void reserve(Index more);
  /// Takes over a row made by solve_rows(), for whatever was stored when it was made. Wait-free; does not allocate.
  /// @param row gets what was in its slot before, to be freed elsewhere
  void take(ComplianceRow& row);
  /// Frees a slot. Wait-free; frees no memory.
  /// @param row gets what was in it
  void release(Index slot, ComplianceRow& row);
  [[nodiscard]] const NodeSlots& slots() const { return slots_; }

  /// Rows that have come since the store was made.
  [[nodiscard]] std::uint64_t arrived() const { return arrived_; }
  [[nodiscard]] Index stored_nodes() const { return stored_nodes_; }
  /// What the rows take if no other store shares them.
  [[nodiscard]] double megabytes() const;
  [[nodiscard]] const Tissue& tissue() const { return *tissue_; }
  [[nodiscard]] const std::shared_ptr<const Tissue>& shared_tissue() const { return tissue_; }

 private:
  struct Row {
    std::shared_ptr<const double[]> blocks;
    Index length = 0;         ///< slots it reaches
    std::uint64_t order = 0;  ///< of arrival
  };

  std::shared_ptr<const Tissue> tissue_;
  NodeSlots slots_;
  std::vector<Row> rows_;  ///< (slots)
  std::uint64_t arrived_ = 0;
  Index stored_nodes_ = 0;
};

}  // namespace stylet
