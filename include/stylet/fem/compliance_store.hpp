// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <cassert>
#include <span>

namespace stylet {

/// Blocks of K⁻¹ between the nodes near the needle. Rows are computed from the factor on demand, before the loop needs
/// them, and kept; reading neither allocates nor solves.
class ComplianceStore {
 public:
  explicit ComplianceStore(std::shared_ptr<const Tissue> tissue);

  /// The blocks among the tissue's corridor(), known from elsewhere.
  /// @param blocks [mm/N] (3c × 3c) as Tissue::compliance_of_corridor() gives them
  ComplianceStore(std::shared_ptr<const Tissue> tissue, MatX blocks);

  /// Makes all blocks among `nodes` and those stored before available, and those of the nodes that the kind of element
  /// adds between two of them. Solves in batches; one call for many nodes costs less than many calls. Numbers outside
  /// the mesh are passed over. Not for the step.
  /// @param nodes of the mesh
  void add_nodes(std::span<const Index> nodes, const Progress& progress = {});

  /// True when the node's blocks are stored. Fixed nodes always count as stored: their compliance is zero.
  [[nodiscard]] bool has(Index node) const { return slot_[node] != kNotStored; }

  /// K⁻¹ block between nodes a and b [mm/N] (3×3): displacement of a per force on b. Both must be stored.
  [[nodiscard]] Mat3 block(Index a, Index b) const {
    assert(has(a) && has(b));
    const Index row = slot_[a];
    const Index column = slot_[b];
    if (row < 0 || column < 0) return Mat3::Zero();
    return blocks_.block<3, 3>(3 * Eigen::Index{row}, 3 * Eigen::Index{column});
  }

  /// All blocks (3 nodes × 3 nodes) [mm/N], in the order of stored().
  [[nodiscard]] const MatX& blocks() const { return blocks_; }
  [[nodiscard]] const std::vector<Index>& stored() const { return nodes_; }

  [[nodiscard]] Index stored_nodes() const { return static_cast<Index>(nodes_.size()); }
  [[nodiscard]] double megabytes() const { return static_cast<double>(blocks_.size()) * 8.0 / 1048576.0; }
  [[nodiscard]] const Tissue& tissue() const { return *tissue_; }
  [[nodiscard]] const std::shared_ptr<const Tissue>& shared_tissue() const { return tissue_; }

 private:
  static constexpr Index kNotStored = -1;
  static constexpr Index kFixed = -2;

  std::shared_ptr<const Tissue> tissue_;
  std::vector<Index> slot_;   ///< (n) slot of a node, kNotStored or kFixed
  std::vector<Index> nodes_;  ///< node of each slot
  MatX blocks_;               ///< (3 slots × 3 slots) [mm/N], symmetric
};

}  // namespace stylet
