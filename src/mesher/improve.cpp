// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_changes.hpp"

#include <algorithm>
#include <array>

namespace stylet::meshing {
namespace {

constexpr int kMostRounds = 12;

bool help(EditableMesh& m, LocalChanges& change, Index t) {
  const auto n = m.tets[t].nodes;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      if (change.remove_edge(n[i], n[j])) return true;
    }
  }
  for (int i = 0; i < 4; ++i) {
    if (change.remove_face(t, i)) return true;
  }
  bool moved = false;
  for (const Index v : n) moved = change.move(v) || moved;
  return moved;
}

}  // namespace

void improve(EditableMesh& m, const Anatomy& anatomy, double goal) {
  for (int round = 0; round < kMostRounds; ++round) {
    // Surfaces give way a little more to what could not be helped otherwise.
    LocalChanges change(m, anatomy, round < 4 ? 0.05 : round < 8 ? 0.1 : 0.15);
    std::vector<std::pair<double, Index>> bad;
    for (std::size_t t = 0; t < m.tets.size(); ++t) {
      if (!m.alive(static_cast<Index>(t))) continue;
      const double q = m.quality(static_cast<Index>(t));
      if (q < goal) bad.emplace_back(q, static_cast<Index>(t));
    }
    std::sort(bad.begin(), bad.end());
    bool any = false;
    for (const auto& [q, t] : bad) {
      if (m.alive(t) && m.quality(t) < goal) any = help(m, change, t) || any;
    }
    if (!any) break;
  }
}

}  // namespace stylet::meshing
