// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume_fit.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

constexpr int kRounds = 6;

/// Volumes of all regions and the areas between them.
struct Sums {
  std::vector<double> volume;             ///< (labels) [mm³]
  std::vector<std::vector<double>> area;  ///< (labels × labels) [mm²], label 0 = outside
};

Sums measure(const EditableMesh& m, std::size_t labels) {
  Sums s{std::vector<double>(labels, 0), std::vector<std::vector<double>>(labels, std::vector<double>(labels, 0))};
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    if (!m.alive(static_cast<Index>(t))) continue;
    const auto& n = m.tets[t].nodes;
    const int label = m.tets[t].label;
    const Vec3& a = m.nodes[n[0]];
    s.volume[label] += (m.nodes[n[1]] - a).cross(m.nodes[n[2]] - a).dot(m.nodes[n[3]] - a) / 6;
    for (int i = 0; i < 4; ++i) {
      const std::array<Index, 3> f{n[(i + 1) % 4], n[(i + 2) % 4], n[(i + 3) % 4]};
      const Index other = m.across(static_cast<Index>(t), f);
      const int there = other < 0 ? 0 : m.tets[other].label;
      if (there == label) continue;
      const double area = 0.5 * (m.nodes[f[1]] - m.nodes[f[0]]).cross(m.nodes[f[2]] - m.nodes[f[0]]).norm();
      s.area[label][there] += area;
      if (there == 0) s.area[0][label] += area;
    }
  }
  return s;
}

/// Shifts the offsets; returns the largest relative volume error before the shift.
double shift_offsets(const Sums& s, Anatomy& a) {
  double worst = 0;
  for (std::size_t l = 0; l < a.layers.size(); ++l) {
    Layer& layer = a.layers[l];
    const auto inside = [&](int label) { return label > 0 && a.layer_of(label) == static_cast<int>(l); };
    const auto yields = [&](int label) { return label == 0 || a.layer_of(label) > static_cast<int>(l); };
    double wanted = 0, have = 0, area = 0;
    for (const int m : layer.members) {
      wanted += a.structures[m].input_volume;
      have += s.volume[m + 1];
      for (std::size_t o = 0; o < s.volume.size(); ++o) {
        if (yields(static_cast<int>(o))) area += s.area[m + 1][o];
      }
    }
    if (!(wanted > 0) || !(area > 0) || !(have > 0)) continue;
    // The shift is limited to a fraction of the structure's thickness.
    const double most = 0.1 * layer.solid->inner_radius();
    const double shift = std::clamp((wanted - have) / area, -most, most);
    worst = std::max(worst, std::abs(have / wanted - 1));
    layer.offset += shift;
    if (layer.members.size() == 1) {
      a.structures[layer.members[0]].offset = layer.offset;
      continue;
    }
    for (const int m : layer.members) {
      Structure& part = a.structures[m];
      double outer = 0, inner = 0;
      for (std::size_t o = 0; o < s.volume.size(); ++o) {
        if (yields(static_cast<int>(o))) outer += s.area[m + 1][o];
        if (inside(static_cast<int>(o))) inner += s.area[m + 1][o];
      }
      if (!(part.input_volume > 0) || !(inner > 0)) continue;
      worst = std::max(worst, std::abs(s.volume[m + 1] / part.input_volume - 1));
      const double bound = 0.1 * part.shape->inner_radius();
      part.offset += std::clamp((part.input_volume - s.volume[m + 1] - shift * outer) / inner, -bound, bound);
    }
  }
  return worst;
}

/// Projects a node onto all its surfaces, one after the other, a few times.
Vec3 onto_surfaces(const Anatomy& a, const std::vector<int>& labels, Vec3 p) {
  const int rounds = labels.size() == 2 ? 1 : 4;
  for (int r = 0; r < rounds; ++r) {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      for (std::size_t j = i + 1; j < labels.size(); ++j) p = a.project(labels[i], labels[j], p);
    }
  }
  return p;
}

}  // namespace

void fit_volumes(EditableMesh& m, Anatomy& a) {
  std::vector<std::vector<int>> labels(m.nodes.size());
  for (std::size_t n = 0; n < m.nodes.size(); ++n) {
    if (!m.around[n].empty()) labels[n] = m.labels_at(static_cast<Index>(n));
  }
  for (int round = 0; round < kRounds; ++round) {
    if (shift_offsets(measure(m, a.structures.size() + 1), a) < 0.003) break;
    for (std::size_t n = 0; n < m.nodes.size(); ++n) {
      if (labels[n].size() < 2) continue;
      const Vec3 from = m.nodes[n];
      const Vec3 to = onto_surfaces(a, labels[n], from);
      // Move as far as the elements around the node stay acceptable, or at least do not become worse.
      const double floor = std::min(1.0, m.quality_around(static_cast<Index>(n)));
      for (double part = 1; part > 0.2; part *= 0.5) {
        m.nodes[n] = from + part * (to - from);
        if (m.quality_around(static_cast<Index>(n)) >= floor) break;
        m.nodes[n] = from;
      }
    }
  }
}

}  // namespace stylet::meshing
