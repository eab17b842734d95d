// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_changes.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace stylet::meshing {
namespace {

constexpr double kGain = 1e-4;  // smaller improvements are not worth a change, and might repeat for ever

/// The triangulation of a ring of nodes between two apexes with the best worst tetrahedron (Klincsek 1980).
struct Fan {
  double worst = 0;
  std::vector<std::array<Index, 3>> triangles;
};

Fan triangulate(const EditableMesh& m, const std::vector<Index>& p, Index bottom, Index top) {
  const int n = static_cast<int>(p.size());
  Fan fan;
  fan.worst = HUGE_VAL;
  if (n < 3) return fan;
  std::vector<std::vector<double>> best(n, std::vector<double>(n, HUGE_VAL));
  std::vector<std::vector<int>> split(n, std::vector<int>(n, -1));
  for (int span = 2; span < n; ++span) {
    for (int i = 0; i + span < n; ++i) {
      const int k = i + span;
      best[i][k] = -HUGE_VAL;
      for (int j = i + 1; j < k; ++j) {
        double q = std::min(best[i][j], best[j][k]);
        if (q <= best[i][k]) continue;
        q = std::min(q, m.quality({p[i], p[j], p[k], top}));
        if (q <= best[i][k]) continue;
        q = std::min(q, m.quality({p[i], p[k], p[j], bottom}));
        if (q > best[i][k]) {
          best[i][k] = q;
          split[i][k] = j;
        }
      }
    }
  }
  fan.worst = best[0][n - 1];
  std::vector<std::pair<int, int>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k - i < 2) continue;
    const int j = split[i][k];
    if (j < 0) {
      fan.worst = 0;
      return fan;
    }
    fan.triangles.push_back({p[i], p[j], p[k]});
    open.emplace_back(i, j);
    open.emplace_back(j, k);
  }
  return fan;
}

}  // namespace

double LocalChanges::shortest_edge(Index node) const {
  double shortest = HUGE_VAL;
  for (const Index t : mesh_.around[node]) {
    for (const Index n : mesh_.tets[t].nodes) {
      if (n != node) shortest = std::min(shortest, (mesh_.nodes[n] - mesh_.nodes[node]).norm());
    }
  }
  return shortest;
}

double LocalChanges::off_surface(const std::vector<int>& labels, const Vec3& p) const {
  double worst = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t j = i + 1; j < labels.size(); ++j) {
      worst = std::max(worst, std::abs(anatomy_.interface_distance(labels[i], labels[j], p)));
    }
  }
  return worst;
}

bool LocalChanges::move(Index node) {
  const std::vector<int> labels = mesh_.labels_at(node);
  const bool surface = labels.size() > 1;
  const double length = shortest_edge(node);
  const Vec3 start = mesh_.nodes[node];
  const double allowed = surface ? std::max(slack_ * length, off_surface(labels, start)) : 0;
  const double before = mesh_.quality_around(node);
  double best = before;
  Vec3 at = start;
  // Pattern search in 26 directions; the step is halved when no direction helps.
  for (double step = 0.3 * length; step > 0.015 * length;) {
    Vec3 chosen = at;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          if (i == 0 && j == 0 && k == 0) continue;
          Vec3 p = at + step * Vec3(i, j, k).normalized();
          if (labels.size() == 2) p = anatomy_.project(labels[0], labels[1], p);
          if (surface && off_surface(labels, p) > allowed) continue;
          mesh_.nodes[node] = p;
          const double q = mesh_.quality_around(node);
          if (q > best + kGain) {
            best = q;
            chosen = p;
          }
        }
      }
    }
    if (chosen == at) {
      step *= 0.5;
    } else {
      at = chosen;
    }
  }
  mesh_.nodes[node] = at;
  return best > before;
}

bool LocalChanges::remove_edge(Index a, Index b) {
  const std::vector<Index> dead = mesh_.around_edge(a, b);
  if (dead.empty() || dead.size() > 9) return false;
  // Ring of nodes around the edge: link from → (to, label), counter-clockwise seen from b.
  std::map<Index, std::pair<Index, int>> link;
  std::map<Index, int> arrivals;
  double before = HUGE_VAL;
  for (const Index t : dead) {
    const auto& n = mesh_.tets[t].nodes;
    before = std::min(before, mesh_.quality(t));
    std::array<Index, 2> other{};
    int count = 0;
    for (const Index v : n) {
      if (v != a && v != b) other[count++] = v;
    }
    const Vec3 &pa = mesh_.nodes[a], &pb = mesh_.nodes[b];
    if ((pb - pa).cross(mesh_.nodes[other[0]] - pa).dot(mesh_.nodes[other[1]] - pa) < 0) std::swap(other[0], other[1]);
    if (link.contains(other[0])) return false;
    link[other[0]] = {other[1], mesh_.tets[t].label};
    ++arrivals[other[1]];
  }
  Index first = link.begin()->first;
  bool open = false;
  for (const auto& [from, to] : link) {
    if (!arrivals.contains(from)) {
      if (open) return false;
      first = from;
      open = true;
    }
  }
  std::vector<Index> ring;
  std::vector<int> label;  // label of the link that starts at ring[i]; 0 = outside
  Index at = first;
  do {
    ring.push_back(at);
    const auto it = link.find(at);
    if (it == link.end()) {
      label.push_back(0);
      break;
    }
    label.push_back(it->second.second);
    at = it->second.first;
  } while (at != first && ring.size() <= dead.size() + 1);
  if (ring.size() != dead.size() + (open ? 1 : 0)) return false;
  // Divide the ring into sectors, one per region.
  const int n = static_cast<int>(ring.size());
  std::vector<int> starts;
  for (int i = 0; i < n; ++i) {
    if (label[i] != label[(i + n - 1) % n]) starts.push_back(i);
  }
  std::vector<std::pair<std::vector<Index>, int>> sectors;
  if (starts.empty()) {
    if (label[0] == 0) return false;
    sectors.emplace_back(ring, label[0]);
  } else if (starts.size() == 2) {
    for (int s = 0; s < 2; ++s) {
      const int from = starts[s], to = starts[1 - s];
      std::vector<Index> chain;
      for (int i = from;; i = (i + 1) % n) {
        chain.push_back(ring[i]);
        if (i == to) break;
      }
      sectors.emplace_back(std::move(chain), label[from]);
    }
    // The diagonal on the surface changes from ab to cd. The new one must be about as near to the surface, and must not
    // already be an edge of it.
    const Index c = ring[starts[0]], d = ring[starts[1]];
    std::vector<int> pair{std::min(sectors[0].second, sectors[1].second),
                          std::max(sectors[0].second, sectors[1].second)};
    const double was = off_surface(pair, 0.5 * (mesh_.nodes[a] + mesh_.nodes[b]));
    const double will = off_surface(pair, 0.5 * (mesh_.nodes[c] + mesh_.nodes[d]));
    const double length = (mesh_.nodes[a] - mesh_.nodes[b]).norm();
    if (will > was + slack_ * length) return false;
    if (mesh_.on_surface(c, d)) return false;
  } else {
    return false;
  }
  double after = HUGE_VAL;
  std::vector<EditableMesh::Tet> born;
  for (const auto& [chain, region] : sectors) {
    if (region == 0) continue;
    const Fan fan = triangulate(mesh_, chain, a, b);
    after = std::min(after, fan.worst);
    if (after <= before + kGain) return false;
    for (const auto& t : fan.triangles) {
      born.push_back({{t[0], t[1], t[2], b}, region});
      born.push_back({{t[0], t[2], t[1], a}, region});
    }
  }
  // Every node must still belong to a tetrahedron.
  for (const Index t : dead) {
    for (const Index v : mesh_.tets[t].nodes) {
      const bool used = std::any_of(born.begin(), born.end(), [&](const EditableMesh::Tet& x) {
        return std::find(x.nodes.begin(), x.nodes.end(), v) != x.nodes.end();
      });
      if (!used && mesh_.around[v].size() <= dead.size()) return false;
    }
  }
  mesh_.replace(dead, born);
  return true;
}

bool LocalChanges::remove_face(Index tet, int local) {
  const auto& n = mesh_.tets[tet].nodes;
  constexpr std::array<std::array<int, 3>, 4> kFace{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const std::array<Index, 3> f{n[kFace[local][0]], n[kFace[local][1]], n[kFace[local][2]]};
  const Index other = mesh_.across(tet, f);
  if (other < 0 || mesh_.tets[other].label != mesh_.tets[tet].label) return false;
  const Index a = n[local];
  Index b = -1;
  for (const Index v : mesh_.tets[other].nodes) {
    if (std::find(f.begin(), f.end(), v) == f.end()) b = v;
  }
  const double before = std::min(mesh_.quality(tet), mesh_.quality(other));
  const int region = mesh_.tets[tet].label;
  // f is counter-clockwise seen from b, so (a, b, f0, f1) has positive volume.
  std::vector<EditableMesh::Tet> born;
  for (int i = 0; i < 3; ++i) {
    born.push_back({{a, b, f[i], f[(i + 1) % 3]}, region});
    if (mesh_.quality(born.back().nodes) <= before + kGain) return false;
  }
  const std::array<Index, 2> dead{tet, other};
  mesh_.replace(dead, born);
  return true;
}

}  // namespace stylet::meshing
