// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/compliance_rows.hpp"

#include <cassert>

namespace stylet {

/// Compliance among the nodes near the needle: blocks of K⁻¹. Rows are computed from the factor before a step needs
/// them; reading a block neither allocates nor solves. A row is never changed, so a copy of a store shares its rows and
/// can grow independently. The block of two nodes is kept in the row that was stored later.
class ComplianceStore {
 public:
  explicit ComplianceStore(std::shared_ptr<const Tissue> tissue);

  /// A store that already contains the blocks among the nodes of the tissue's corridor().
  /// @param blocks [mm/N] (3c × 3c) from Tissue::compliance_of_corridor()
  ComplianceStore(std::shared_ptr<const Tissue> tissue, const MatX& blocks);

  /// Adds nodes: afterwards the blocks among `nodes` and all stored nodes are available, also for the nodes that the
  /// kind of element adds between two of them. Solves in batches; one call for many nodes costs less than many calls.
  /// Not to be called in a step.
  /// @param nodes nodes of the mesh; numbers outside the mesh are ignored
  void add_nodes(std::span<const Index> nodes, const Progress& progress = {});

  /// Whether the blocks of a node are stored. Always true for fixed nodes, whose compliance is zero.
  [[nodiscard]] bool has(Index node) const { return slots_.has(node) || tissue_->is_fixed(node); }

  /// Block of K⁻¹ between nodes a and b [mm/N] (3×3): displacement of a per force on b. Both nodes must be stored.
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

  /// All blocks [mm/N] (3 × nodes square), in the order of stored(). Allocates.
  [[nodiscard]] MatX blocks() const;
  /// The stored nodes, in the order of their slots.
  [[nodiscard]] std::vector<Index> stored() const;

  /// Adds `more` free slots at the end, for take(). Allocates.
  void reserve(Index more);
  /// Stores a row made by solve_rows(). The nodes that were stored when it was made must still be in their slots.
  /// Wait-free; does not allocate.
  /// @param row receives the previous contents of the slot, whose memory the caller frees outside the step
  void take(ComplianceRow& row);
  /// Frees a slot. Wait-free; does not free memory.
  /// @param row receives the contents of the slot
  void release(Index slot, ComplianceRow& row);
  [[nodiscard]] const NodeSlots& slots() const { return slots_; }

  /// Number of rows that have been stored since the store was made.
  [[nodiscard]] std::uint64_t arrived() const { return arrived_; }
  [[nodiscard]] Index stored_nodes() const { return stored_nodes_; }
  /// Memory of the rows [MB], including rows that are shared with other stores.
  [[nodiscard]] double megabytes() const;
  [[nodiscard]] const Tissue& tissue() const { return *tissue_; }
  [[nodiscard]] const std::shared_ptr<const Tissue>& shared_tissue() const { return tissue_; }

 private:
  struct Row {
    std::shared_ptr<const double[]> blocks;
    Index length = 0;         ///< number of slots that the row covers
    std::uint64_t order = 0;  ///< value of arrived_ when the row was stored
  };

  std::shared_ptr<const Tissue> tissue_;
  NodeSlots slots_;
  std::vector<Row> rows_;  ///< (slots)
  std::uint64_t arrived_ = 0;
  Index stored_nodes_ = 0;
};

}  // namespace stylet
