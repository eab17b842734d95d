// SPDX-License-Identifier: GPL-3.0-or-later
#include "nodal_pressure.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace stylet::detail {
namespace {

// The material without the averaged part of the energy: the same μ, λ = 0.
Material without_volume(const Material& material) { return {2.0 * material.mu(), 0.0}; }

}  // namespace

void NodalPressure::for_each_group(std::span<const Index> tets, const MaterialOf& material,
                                   const std::function<void(const Group&)>& visit) const {
  // The elements around each node: those of node k are around[begin[k]] … around[begin[k + 1] − 1].
  std::vector<Index> number(mesh_.nodes.size(), 0);  // of elements around each node, then where the next one goes
  std::vector<Index> all;
  for (const Index t : tets) {
    for (const Index a : mesh_.tets[t]) {
      if (number[a]++ == 0) all.push_back(a);
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<Index> begin{0};
  for (const Index a : all) {
    begin.push_back(begin.back() + number[a]);
    number[a] = begin[begin.size() - 2];
  }
  std::vector<Index> around(4 * tets.size());
  for (const Index t : tets) {
    for (const Index a : mesh_.tets[t]) around[number[a]++] = t;
  }
  std::vector<Index> rest;
  std::vector<Index> group;
  std::vector<Index> nodes;
  std::vector<Index>& group_of = number;  // the number of the last group that has a node
  std::fill(group_of.begin(), group_of.end(), -1);
  Index groups = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    rest.assign(around.begin() + begin[k], around.begin() + begin[k + 1]);
    while (!rest.empty()) {
      const Material one = material(rest.front());
      const auto others = std::stable_partition(rest.begin(), rest.end(), [&](Index t) { return material(t) == one; });
      group.assign(rest.begin(), others);
      rest.erase(rest.begin(), others);
      nodes.clear();
      double volume = 0.0;
      for (const Index t : group) {
        volume += 0.25 * tet_volume(mesh_, t);
        for (const Index a : mesh_.tets[t]) {
          if (std::exchange(group_of[a], groups) != groups) nodes.push_back(a);
        }
      }
      std::sort(nodes.begin(), nodes.end());
      visit({group, nodes, one, volume});
      ++groups;
    }
  }
}

void NodalPressure::parts(std::span<const Index> tets, const MaterialOf& material, const Visit& visit) const {
  LinearTetrahedra::parts(tets, material, visit);
  for_each_group(tets, material, [&](const Group& group) { visit(group.nodes); });
}

void NodalPressure::stiffness(std::span<const Index> tets, const MaterialOf& material, const Add& add) const {
  LinearTetrahedra::stiffness(
      tets, [&](Index t) { return without_volume(material(t)); }, add);
  // Kept for all groups, because they would take longer to allocate than to fill.
  VecX d;
  MatX K;
  for_each_group(tets, material, [&](const Group& group) {
    const auto rows = 3 * static_cast<Eigen::Index>(group.nodes.size());
    if (rows > d.size()) {
      d.resize(rows);
      K.resize(rows, rows);
    }
    // d is defined by V_a θ_a = dᵀ u.
    auto of_group = d.head(rows);
    of_group.setZero();
    for (const Index t : group.tets) {
      const auto gradients = barycentric_gradients(mesh_, t);
      const double quarter = 0.25 * tet_volume(mesh_, t);
      for (int b = 0; b < 4; ++b) {
        const auto at =
            std::lower_bound(group.nodes.begin(), group.nodes.end(), mesh_.tets[t][b]) - group.nodes.begin();
        of_group.segment<3>(3 * at) += quarter * gradients.col(b);
      }
    }
    // Blocks on the diagonal are wanted whole, others below it only.
    auto of_nodes = K.topLeftCorner(rows, rows);
    const double stiffness = group.material.lambda() / group.volume;
    for (Eigen::Index j = 0; j < rows; ++j) {
      const Eigen::Index below = rows - j / 3 * 3;
      of_nodes.col(j).tail(below) = (of_group.tail(below) * of_group[j]) * stiffness;
    }
    add(group.nodes, of_nodes);
  });
}

/// Files of a run ask for the stresses of each frame, so the groups of all nodes are found without sorting.
MatX NodalPressure::stress(const MaterialOf& material, const VecX& u) const {
  struct Sums {
    Material material;
    Index next;           // another group of the same node; −1: none
    double change = 0.0;  // [mm³] Σ V_e / 4 div u_e
    double volume = 0.0;  // [mm³] Σ V_e / 4
  };
  std::vector<Sums> groups;
  groups.reserve(mesh_.nodes.size() + mesh_.nodes.size() / 4);
  std::vector<Index> first(mesh_.nodes.size(), -1);  // a group of each node
  std::vector<std::array<Index, 4>> group_of(mesh_.tets.size());
  for (Index t = 0; t < mesh_.tet_count(); ++t) {
    const Material of_tet = material(t);
    const double quarter = 0.25 * tet_volume(mesh_, t);
    const double divergence = gradient(t, u).trace();
    for (std::size_t a = 0; a < 4; ++a) {
      Index& newest = first[mesh_.tets[t][a]];
      Index group = newest;
      while (group >= 0 && !(groups[group].material == of_tet)) group = groups[group].next;
      if (group < 0) {
        group = static_cast<Index>(groups.size());
        groups.push_back({of_tet, newest});
        newest = group;
      }
      groups[group].change += quarter * divergence;
      groups[group].volume += quarter;
      group_of[t][a] = group;
    }
  }
  MatX stresses = LinearTetrahedra::stress([&](Index t) { return without_volume(material(t)); }, u);
  for (Index t = 0; t < mesh_.tet_count(); ++t) {
    double pressure = 0.0;
    for (const Index g : group_of[t]) {
      const Sums& group = groups[g];
      pressure += 0.25 * group.material.lambda() * group.change / group.volume;
    }
    stresses.col(t).head<3>().array() += pressure;
  }
  return stresses;
}

}  // namespace stylet::detail
