// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/quadratic_part.hpp"

#include "discretisation.hpp"

#include <algorithm>
#include <utility>

namespace stylet {

Result<QuadraticPart> QuadraticPart::build(const Tissue& whole, const std::function<bool(const Vec3&)>& is_near) {
  const TetMesh& mesh = whole.mesh();
  std::vector<char> near(mesh.nodes.size(), 0);
  for (std::size_t k = 0; k < near.size(); ++k) near[k] = is_near(mesh.nodes[k]) ? 1 : 0;
  QuadraticPart result;
  result.number_.assign(mesh.tets.size(), -1);
  TetMesh part;
  part.regions = mesh.regions;
  std::vector<Index> part_node(mesh.nodes.size(), -1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& corners = mesh.tets[t];
    if (std::none_of(corners.begin(), corners.end(), [&](Index k) { return near[static_cast<std::size_t>(k)] != 0; }))
      continue;
    result.number_[t] = part.tet_count();
    part.tet_region.push_back(mesh.tet_region[t]);
    auto& own = part.tets.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      Index& at = part_node[static_cast<std::size_t>(corners[i])];
      if (at < 0) {
        at = part.node_count();
        part.nodes.push_back(mesh.nodes[static_cast<std::size_t>(corners[i])]);
        result.node_.push_back(corners[i]);
      }
      own[i] = at;
    }
  }
  std::vector<char> held(part.nodes.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (result.number_[t] >= 0) continue;
    for (const Index corner : mesh.tets[t]) {
      const Index at = part_node[static_cast<std::size_t>(corner)];
      if (at >= 0) held[static_cast<std::size_t>(at)] = 1;
    }
  }
  result.has_node_.assign(mesh.nodes.size(), 0);
  for (const Index k : result.node_) result.has_node_[static_cast<std::size_t>(k)] = 1;
  std::vector<Index> fixed;
  for (Index k = 0; k < part.node_count(); ++k) {
    if (held[static_cast<std::size_t>(k)] != 0 || whole.is_fixed(result.node_of_whole(k))) fixed.push_back(k);
  }
  auto tissue = Tissue::build(std::move(part), whole.materials(), fixed, {}, Element::p2);
  if (!tissue) return tissue.error();
  result.tissue_ = std::make_unique<Tissue>(std::move(*tissue));
  result.couple_rim();
  return result;
}

void QuadraticPart::couple_rim() {
  const Tissue& tissue = *tissue_;
  const auto is_rim = [&](Index node) { return tissue.is_fixed(node); };
  std::vector<Index> at_rim;
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) {
    const auto nodes = tissue.nodes_of(t);
    if (std::any_of(nodes.begin(), nodes.end(), is_rim)) at_rim.push_back(t);
  }
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](std::span<const Index> nodes, const Eigen::Ref<const MatX>& K) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        if (is_rim(nodes[i]) || !is_rim(nodes[j])) continue;
        const auto row = static_cast<Eigen::Index>(3 * i), column = static_cast<Eigen::Index>(3 * j);
        const Mat3 block = i > j ? Mat3(K.block<3, 3>(row, column)) : Mat3(K.block<3, 3>(column, row).transpose());
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) entries.emplace_back(3 * nodes[i] + r, 3 * nodes[j] + c, block(r, c));
        }
      }
    }
  };
  const auto material = [&](Index t) { return tissue.material(tissue.mesh().tet_region[static_cast<std::size_t>(t)]); };
  tissue.discretisation().stiffness(at_rim, material, add);
  const Eigen::Index rows = 3 * Eigen::Index{tissue.displacement_nodes()};
  coupling_.resize(rows, rows);
  coupling_.setFromTriplets(entries.begin(), entries.end());
}

void QuadraticPart::add_rim_forces(const MatX& loads, const MatX& u, MatX& on_whole) const {
  const MatX pulls = coupling_.transpose() * u;
  for (const Index node : tissue_->fixed_nodes()) {
    for (const Index end : tissue_->ends_of(node)) {
      on_whole.middleRows<3>(3 * Eigen::Index{node_of_whole(end)}) +=
          0.5 * (loads.middleRows<3>(3 * Eigen::Index{node}) - pulls.middleRows<3>(3 * Eigen::Index{node}));
    }
  }
}

MatX QuadraticPart::with_rim_moved(const MatX& of_whole) const {
  MatX rim = MatX::Zero(coupling_.rows(), of_whole.cols());
  for (const Index node : tissue_->fixed_nodes()) {
    for (const Index end : tissue_->ends_of(node)) {
      rim.middleRows<3>(3 * Eigen::Index{node}) += 0.5 * of_whole.middleRows<3>(3 * Eigen::Index{node_of_whole(end)});
    }
  }
  return rim + tissue_->solve(-(coupling_ * rim));
}

}  // namespace stylet
