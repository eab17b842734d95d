// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_changes.hpp"

#include <algorithm>
#include <array>

namespace stylet::meshing {
namespace {

constexpr int kMostRounds = 8;

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
  // The slack of surfaces grows for elements that could not be improved otherwise.
  for (const double slack : {0.05, 0.1, 0.15}) {
    LocalChanges change(m, anatomy, slack);
    for (int round = 0; round < kMostRounds; ++round) {
      std::vector<std::pair<double, Index>> bad;
      for (std::size_t t = 0; t < m.tets.size(); ++t) {
        if (!m.alive(static_cast<Index>(t))) continue;
        const double q = m.quality(static_cast<Index>(t));
        if (q < goal) bad.emplace_back(q, static_cast<Index>(t));
      }
      if (bad.empty()) return;
      std::sort(bad.begin(), bad.end());
      bool any = false;
      for (const auto& [q, t] : bad) {
        if (m.alive(t) && m.quality(t) < goal) any = help(m, change, t) || any;
      }
      if (!any) break;
    }
  }
}

}  // namespace stylet::meshing
