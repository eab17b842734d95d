// SPDX-License-Identifier: GPL-3.0-or-later
#include "nodes_ahead.hpp"

#include <algorithm>

namespace stylet {
namespace {

/// A node at a distance beside the way counts as this many times that distance along the way.
constexpr double kBeside = 2.0;

}  // namespace

NodesAhead::NodesAhead(std::shared_ptr<const Tissue> tissue, const Locator& locator)
    : tissue_(std::move(tissue)),
      locator_(locator),
      tet_seen_(static_cast<std::size_t>(tissue_->mesh().tet_count()), 0),
      node_seen_(static_cast<std::size_t>(tissue_->displacement_nodes()), 0) {}

const std::vector<Index>& NodesAhead::find(const NeedleWhereabouts& needle, double radius_mm, double ahead_mm) {
  nodes_.clear();
  Vec3 from = needle.tip;
  Index start = needle.tet;
  if (start < 0) {
    const Vec3 to = from + (radius_mm + ahead_mm) * needle.direction;
    const auto entry = locator_.first_entry(from, to);
    if (!entry) return nodes_;
    start = entry->tet;
    from += entry->t * (to - from);
  }
  const TetMesh& mesh = locator_.mesh();
  ++round_;
  tets_.clear();
  tets_.push_back({0.0, start});
  tet_seen_[static_cast<std::size_t>(start)] = round_;
  for (std::size_t head = 0; head < tets_.size(); ++head) {
    for (const Index next : locator_.topology().neighbour[static_cast<std::size_t>(tets_[head].tet)]) {
      if (next < 0 || tet_seen_[static_cast<std::size_t>(next)] == round_) continue;
      // An element counts when its bounding sphere meets the surroundings of the way.
      const auto& corners = mesh.tets[static_cast<std::size_t>(next)];
      Vec3 middle = Vec3::Zero();
      for (const Index node : corners) middle += 0.25 * mesh.nodes[static_cast<std::size_t>(node)];
      double size = 0.0;
      for (const Index node : corners)
        size = std::max(size, (mesh.nodes[static_cast<std::size_t>(node)] - middle).norm());
      const double along = std::clamp((middle - from).dot(needle.direction), 0.0, ahead_mm);
      const double beside = std::max(0.0, (middle - from - along * needle.direction).norm() - size);
      if (beside > radius_mm) continue;
      tet_seen_[static_cast<std::size_t>(next)] = round_;
      tets_.push_back({along + kBeside * beside, next});
    }
  }
  std::sort(tets_.begin(), tets_.end(), [](const Near& a, const Near& b) {
    return a.reached_mm < b.reached_mm || (a.reached_mm == b.reached_mm && a.tet < b.tet);
  });
  for (const Near& near : tets_) {
    for (const Index node : tissue_->nodes_of(near.tet)) {
      if (node_seen_[static_cast<std::size_t>(node)] == round_) continue;
      node_seen_[static_cast<std::size_t>(node)] = round_;
      nodes_.push_back(node);
    }
  }
  return nodes_;
}

}  // namespace stylet
