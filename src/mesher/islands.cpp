// SPDX-License-Identifier: GPL-3.0-or-later
#include "islands.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stylet::meshing {

Islands find_islands(const GridShape& g) {
  Islands islands;
  islands.piece.assign(g.values.size(), -1);
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(g.size[0]),
                                          static_cast<std::size_t>(g.size[0]) * g.size[1]};
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < g.values.size(); ++start) {
    if (g.values[start] >= 0 || islands.piece[start] >= 0) continue;
    const int number = static_cast<int>(islands.volume.size());
    std::size_t count = 0;
    open.assign(1, start);
    islands.piece[start] = number;
    while (!open.empty()) {
      const std::size_t n = open.back();
      open.pop_back();
      ++count;
      for (int a = 0; a < 3; ++a) {
        const int c = static_cast<int>(n / stride[a] % static_cast<std::size_t>(g.size[a]));
        for (const int step : {-1, 1}) {
          if (c + step < 0 || c + step >= g.size[a]) continue;
          const std::size_t next = step > 0 ? n + stride[a] : n - stride[a];
          if (g.values[next] >= 0 || islands.piece[next] >= 0) continue;
          islands.piece[next] = number;
          open.push_back(next);
        }
      }
    }
    islands.volume.push_back(static_cast<double>(count) * g.spacing.prod());
  }
  return islands;
}

double keep_islands(GridShape& g, const Islands& islands, const std::vector<bool>& keep) {
  double kept = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) kept += keep[i] ? islands.volume[i] : 0;
  const double all = std::accumulate(islands.volume.begin(), islands.volume.end(), 0.0);
  if (kept == all) return 1;
  for (std::size_t n = 0; n < g.values.size(); ++n) {
    if (islands.piece[n] >= 0 && !keep[islands.piece[n]]) g.values[n] = std::abs(g.values[n]);
  }
  redistance(g);
  return kept / all;
}

double drop_small_islands(GridShape& g, double fraction) {
  const Islands islands = find_islands(g);
  if (islands.volume.size() < 2) return 0;
  const double largest = *std::max_element(islands.volume.begin(), islands.volume.end());
  std::vector<bool> keep;
  double dropped = 0;
  for (const double v : islands.volume) {
    keep.push_back(v >= fraction * largest);
    dropped += keep.back() ? 0 : v;
  }
  keep_islands(g, islands, keep);
  return dropped;
}

}  // namespace stylet::meshing
