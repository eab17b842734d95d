// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/compliance_store.hpp"

#include <algorithm>

namespace stylet {

ComplianceStore::ComplianceStore(std::shared_ptr<const Tissue> tissue)
    : tissue_(std::move(tissue)), slots_(tissue_->displacement_nodes()) {}

ComplianceStore::ComplianceStore(std::shared_ptr<const Tissue> tissue, const MatX& blocks)
    : ComplianceStore(std::move(tissue)) {
  const std::vector<Index>& nodes = tissue_->corridor();
  const std::size_t count = nodes.size();
  assert(blocks.rows() == static_cast<Eigen::Index>(3 * count) && blocks.cols() == blocks.rows());
  reserve(static_cast<Index>(count));
  const std::shared_ptr<double[]> all(new double[9 * (count * (count + 1) / 2)]);
  double* at = all.get();
  for (std::size_t row = 0; row < count; ++row) {
    slots_.occupy(static_cast<Index>(row), nodes[row]);
    rows_[row] = {std::shared_ptr<const double[]>(all, at), static_cast<Index>(row) + 1, ++arrived_};
    for (std::size_t column = 0; column <= row; ++column, at += 9) {
      // Each row has the blocks up to the diagonal. They are read as transposes of the blocks above it, because that
      // follows the column-major memory of the matrix.
      Eigen::Map<Mat3>{at} =
          blocks.block<3, 3>(static_cast<Eigen::Index>(3 * column), static_cast<Eigen::Index>(3 * row)).transpose();
    }
  }
  stored_nodes_ = static_cast<Index>(count);
}

void ComplianceStore::reserve(Index more) {
  slots_.resize(slots_.count() + more);
  rows_.resize(static_cast<std::size_t>(slots_.count()));
}

void ComplianceStore::take(ComplianceRow& row) {
  slots_.occupy(row.slot, row.node);
  Row& place = rows_[static_cast<std::size_t>(row.slot)];
  place.blocks.swap(row.blocks);
  place.length = row.length;
  place.order = ++arrived_;
  ++stored_nodes_;
}

void ComplianceStore::release(Index slot, ComplianceRow& row) {
  row.node = slots_.node(slot);
  row.slot = slot;
  Row& place = rows_[static_cast<std::size_t>(slot)];
  row.blocks.swap(place.blocks);
  row.length = place.length;
  place.length = 0;
  slots_.vacate(slot);
  --stored_nodes_;
}

void ComplianceStore::add_nodes(std::span<const Index> nodes, const Progress& progress) {
  const Index corners = tissue_->mesh().node_count();
  std::vector<char> wanted(static_cast<std::size_t>(tissue_->displacement_nodes()), 0);
  std::vector<Index> fresh;
  const auto want = [&](Index node) {
    if (has(node) || wanted[static_cast<std::size_t>(node)] != 0) return;
    wanted[static_cast<std::size_t>(node)] = 1;
    fresh.push_back(node);
  };
  for (const Index node : nodes) {
    if (node >= 0 && node < corners) want(node);
  }
  // A node in the middle of an edge is added when both ends of the edge are stored or will be.
  const auto there = [&](Index node) { return has(node) || wanted[static_cast<std::size_t>(node)] != 0; };
  for (Index node = corners; node < tissue_->displacement_nodes(); ++node) {
    const auto [one, other] = tissue_->ends_of(node);
    if (there(one) && there(other)) want(node);
  }
  if (fresh.empty()) return;

  std::vector<Index> slots;
  for (Index slot = 0; slot < slots_.count() && slots.size() < fresh.size(); ++slot) {
    if (slots_.node(slot) < 0) slots.push_back(slot);
  }
  const Index old = slots_.count();
  reserve(static_cast<Index>(fresh.size() - slots.size()));
  for (Index slot = old; slot < slots_.count(); ++slot) slots.push_back(slot);
  for (ComplianceRow& row : solve_rows(*tissue_, slots_, fresh, slots, progress)) take(row);
}

MatX ComplianceStore::blocks() const {
  const std::vector<Index> nodes = stored();
  const auto count = static_cast<Eigen::Index>(nodes.size());
  MatX all(3 * count, 3 * count);
  for (Eigen::Index column = 0; column < count; ++column) {
    for (Eigen::Index row = 0; row < count; ++row) {
      all.block<3, 3>(3 * row, 3 * column) =
          block(nodes[static_cast<std::size_t>(row)], nodes[static_cast<std::size_t>(column)]);
    }
  }
  return all;
}

std::vector<Index> ComplianceStore::stored() const {
  std::vector<Index> nodes;
  for (Index slot = 0; slot < slots_.count(); ++slot) {
    if (slots_.node(slot) >= 0) nodes.push_back(slots_.node(slot));
  }
  return nodes;
}

double ComplianceStore::megabytes() const {
  double blocks = 0.0;
  for (const Row& row : rows_) blocks += row.length;
  return 9.0 * blocks * 8.0 / 1048576.0;
}

}  // namespace stylet
