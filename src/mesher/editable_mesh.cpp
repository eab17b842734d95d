// SPDX-License-Identifier: GPL-3.0-or-later
#include "editable_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::meshing {

double tet_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b;
  if (!(ab.cross(ac).dot(ad) > 0)) return 0;
  // Outward face normals. The angle between two faces is π − the angle between their normals.
  const std::array<Vec3, 4> n{bc.cross(bd).normalized(), ad.cross(ac).normalized(), ab.cross(ad).normalized(),
                              ac.cross(ab).normalized()};
  double low = 1, high = -1;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const double cosine = -n[i].dot(n[j]);
      low = std::min(low, cosine);
      high = std::max(high, cosine);
    }
  }
  constexpr double kDegree = 180 / std::numbers::pi;
  const double smallest = kDegree * std::acos(std::clamp(high, -1.0, 1.0));
  const double largest = kDegree * std::acos(std::clamp(low, -1.0, 1.0));
  // Radius ratio 3 r_in / r_circ with r_in = 3V/A and r_circ = |ad² (ab×ac) + ac² (ad×ab) + ab² (ac×ad)| / 12V.
  const double volume6 = ab.cross(ac).dot(ad);
  const double area2 = bc.cross(bd).norm() + ad.cross(ac).norm() + ab.cross(ad).norm() + ac.cross(ab).norm();
  const double circum =
      (ad.squaredNorm() * ab.cross(ac) + ac.squaredNorm() * ad.cross(ab) + ab.squaredNorm() * ac.cross(ad)).norm();
  const double ratio = 6 * volume6 * volume6 / (area2 * circum);
  return std::min({smallest / kSmallestAngle, (180 - largest) / (180 - kLargestAngle), ratio / kSmallestRatio});
}

EditableMesh::EditableMesh(RawMesh mesh) : nodes(std::move(mesh.nodes)) {
  around.resize(nodes.size());
  tets.reserve(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    tets.push_back({mesh.tets[t], mesh.label[t]});
    for (const Index n : mesh.tets[t]) around[n].push_back(static_cast<Index>(t));
  }
  on_outside.assign(nodes.size(), false);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const auto& n = tets[t].nodes;
    for (int i = 0; i < 4; ++i) {
      const std::array<Index, 3> face{n[(i + 1) % 4], n[(i + 2) % 4], n[(i + 3) % 4]};
      if (across(static_cast<Index>(t), face) >= 0) continue;
      for (const Index v : face) on_outside[v] = true;
    }
  }
}

double EditableMesh::quality_around(Index node) const {
  double worst = HUGE_VAL;
  for (const Index t : around[node]) worst = std::min(worst, quality(t));
  return worst;
}

double EditableMesh::worst_quality() const {
  double worst = HUGE_VAL;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    if (alive(static_cast<Index>(t))) worst = std::min(worst, quality(static_cast<Index>(t)));
  }
  return worst;
}

std::vector<int> EditableMesh::labels_at(Index node) const {
  std::vector<int> labels;
  if (on_outside[node]) labels.push_back(0);
  for (const Index t : around[node]) labels.push_back(tets[t].label);
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

std::vector<Index> EditableMesh::around_edge(Index a, Index b) const {
  std::vector<Index> both;
  for (const Index t : around[a]) {
    const auto& n = tets[t].nodes;
    if (std::find(n.begin(), n.end(), b) != n.end()) both.push_back(t);
  }
  return both;
}

bool EditableMesh::on_surface(Index a, Index b) const {
  for (const Index t : around_edge(a, b)) {
    for (const Index v : tets[t].nodes) {
      if (v == a || v == b) continue;
      const Index other = across(t, {a, b, v});
      if (other < 0 || tets[other].label != tets[t].label) return true;
    }
  }
  return false;
}

Index EditableMesh::across(Index tet, const std::array<Index, 3>& face) const {
  for (const Index t : around[face[0]]) {
    if (t == tet) continue;
    const auto& n = tets[t].nodes;
    if (std::find(n.begin(), n.end(), face[1]) != n.end() && std::find(n.begin(), n.end(), face[2]) != n.end())
      return t;
  }
  return -1;
}

void EditableMesh::replace(std::span<const Index> dead, std::span<const Tet> born) {
  for (const Index t : dead) {
    for (const Index n : tets[t].nodes) std::erase(around[n], t);
    tets[t].label = 0;
  }
  for (const Tet& b : born) {
    const auto t = static_cast<Index>(tets.size());
    tets.push_back(b);
    for (const Index n : b.nodes) around[n].push_back(t);
  }
}

RawMesh EditableMesh::result() const {
  RawMesh m;
  std::vector<Index> number(nodes.size(), -1);
  for (const Tet& t : tets) {
    if (t.label == 0) continue;
    std::array<Index, 4> n{};
    for (int i = 0; i < 4; ++i) {
      Index& k = number[t.nodes[i]];
      if (k < 0) {
        k = static_cast<Index>(m.nodes.size());
        m.nodes.push_back(nodes[t.nodes[i]]);
      }
      n[i] = k;
    }
    m.tets.push_back(n);
    m.label.push_back(t.label);
  }
  return m;
}

}  // namespace stylet::meshing
