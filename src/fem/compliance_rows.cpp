// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/compliance_rows.hpp"

#include <algorithm>
#include <array>

namespace stylet {
namespace {

// Number of nodes for which one batch solves; each has three right-hand sides.
constexpr std::size_t kBatchNodes = 64;

}  // namespace

std::vector<ComplianceRow> solve_rows(const Tissue& tissue, const NodeSlots& stored, std::span<const Index> nodes,
                                      std::span<const Index> slots, const Progress& progress) {
  std::vector<std::array<Index, 2>> others;  // slot and node
  for (Index slot = 0; slot < stored.count(); ++slot) {
    if (stored.node(slot) >= 0) others.push_back({slot, stored.node(slot)});
  }
  Index length = others.empty() ? 0 : others.back()[0] + 1;

  std::vector<ComplianceRow> rows;
  const Eigen::Index dofs = 3 * Eigen::Index{tissue.displacement_nodes()};
  for (std::size_t first = 0; first < nodes.size(); first += kBatchNodes) {
    report(progress, "compliance", static_cast<double>(first) / static_cast<double>(nodes.size()));
    const std::size_t count = std::min(kBatchNodes, nodes.size() - first);
    MatX f = MatX::Zero(dofs, static_cast<Eigen::Index>(3 * count));
    for (std::size_t i = 0; i < count; ++i)
      f.block<3, 3>(3 * Eigen::Index{nodes[first + i]}, static_cast<Eigen::Index>(3 * i)).setIdentity();
    const MatX u = tissue.solve(f);
    for (std::size_t i = 0; i < count; ++i) {
      const Index node = nodes[first + i];
      const Index own = slots[first + i];
      others.push_back({own, node});
      length = std::max(length, own + 1);
      auto blocks = std::make_shared<double[]>(9 * static_cast<std::size_t>(length));  // zeros
      for (const auto& [slot, other] : others) {
        // By symmetry of K⁻¹, the displacement of the other node per force on this one is the transpose of this block.
        const Mat3 there = u.block<3, 3>(3 * Eigen::Index{other}, static_cast<Eigen::Index>(3 * i));
        Eigen::Map<Mat3>(blocks.get() + 9 * std::ptrdiff_t{slot}) = there.transpose();
      }
      Eigen::Map<Mat3> self(blocks.get() + 9 * std::ptrdiff_t{own});
      self = 0.5 * (self + self.transpose()).eval();  // the solution is symmetric only up to rounding
      rows.push_back({node, own, length, std::move(blocks)});
    }
  }
  report(progress, "compliance", 1.0);
  return rows;
}

}  // namespace stylet
