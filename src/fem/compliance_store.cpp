// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/compliance_store.hpp"

#include <algorithm>

namespace stylet {
namespace {

// Nodes solved for at once: three right-hand sides each.
constexpr std::size_t kBatchNodes = 64;

}  // namespace

ComplianceStore::ComplianceStore(std::shared_ptr<const Tissue> tissue)
    : tissue_(std::move(tissue)), slot_(static_cast<std::size_t>(tissue_->displacement_nodes()), kNotStored) {
  for (const Index a : tissue_->fixed_nodes()) slot_[a] = kFixed;
}

ComplianceStore::ComplianceStore(std::shared_ptr<const Tissue> tissue, MatX blocks)
    : ComplianceStore(std::move(tissue)) {
  nodes_ = tissue_->corridor();
  blocks_ = std::move(blocks);
  assert(blocks_.rows() == static_cast<Eigen::Index>(3 * nodes_.size()) && blocks_.cols() == blocks_.rows());
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) slot_[nodes_[slot]] = static_cast<Index>(slot);
}

void ComplianceStore::add_nodes(std::span<const Index> nodes, const Progress& progress) {
  const std::size_t old = nodes_.size();
  for (const Index a : nodes) {
    if (a < 0 || a >= tissue_->mesh().node_count() || slot_[a] != kNotStored) continue;
    slot_[a] = static_cast<Index>(nodes_.size());
    nodes_.push_back(a);
  }
  // Nodes in the middle of an edge go with its ends.
  for (Index a = tissue_->mesh().node_count(); a < tissue_->displacement_nodes(); ++a) {
    const auto [one, other] = tissue_->ends_of(a);
    if (slot_[a] != kNotStored || !has(one) || !has(other)) continue;
    slot_[a] = static_cast<Index>(nodes_.size());
    nodes_.push_back(a);
  }
  if (nodes_.size() == old) return;

  const auto total = static_cast<Eigen::Index>(3 * nodes_.size());
  const auto kept = static_cast<Eigen::Index>(3 * old);
  blocks_.conservativeResize(total, total);
  const Eigen::Index rows = 3 * Eigen::Index{tissue_->displacement_nodes()};
  for (std::size_t first = old; first < nodes_.size(); first += kBatchNodes) {
    report(progress, "compliance", static_cast<double>(first - old) / static_cast<double>(nodes_.size() - old));
    const std::size_t count = std::min(kBatchNodes, nodes_.size() - first);
    MatX f = MatX::Zero(rows, static_cast<Eigen::Index>(3 * count));
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        f(3 * Eigen::Index{nodes_[first + i]} + axis, static_cast<Eigen::Index>(3 * i) + axis) = 1.0;
      }
    }
    const MatX u = tissue_->solve(f);
    for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
      blocks_.block(static_cast<Eigen::Index>(3 * slot), static_cast<Eigen::Index>(3 * first), 3, u.cols()) =
          u.middleRows<3>(3 * Eigen::Index{nodes_[slot]});
    }
  }

  // K⁻¹ is symmetric, its columns from the factor only to rounding. Where both halves were solved for take the mean,
  // elsewhere mirror, so that action equals reaction to the last bit.
  for (Eigen::Index column = kept; column < total; ++column) {
    for (Eigen::Index row = 0; row < column; ++row) {
      if (row >= kept) blocks_(row, column) = 0.5 * (blocks_(row, column) + blocks_(column, row));
      blocks_(column, row) = blocks_(row, column);
    }
  }
  report(progress, "compliance", 1.0);
}

}  // namespace stylet
