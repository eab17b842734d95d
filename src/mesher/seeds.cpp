// SPDX-License-Identifier: GPL-3.0-or-later
#include "seeds.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace stylet::meshing {
namespace {

/// The surface point between p and q, whose labels differ, found by bisection, with the labels of its two sides.
SurfaceSeed cut(const Anatomy& a, Vec3 p, int label_p, Vec3 q, int label_q) {
  while ((q - p).squaredNorm() > 1e-8) {
    const Vec3 m = 0.5 * (p + q);
    const int label = a.label(m);
    if (label == label_p) {
      p = m;
    } else {
      q = m;
      label_q = label;
    }
  }
  return {0.5 * (p + q), {std::min(label_p, label_q), std::max(label_p, label_q)}};
}

}  // namespace

std::vector<SurfaceSeed> surface_seeds(const Anatomy& a, const SizeField& size, double scale, double spacing) {
  // Process one structure after the other, thin ones first, each on a lattice that fits its thickness. Otherwise the
  // seeds of a large solid would leave no room for those of a small one.
  std::vector<SurfaceSeed> kept;
  std::map<std::array<int, 3>, std::vector<int>> bins;
  constexpr double kBin = 10.0;
  const auto bin = [](const Vec3& p) {
    return std::array<int, 3>{static_cast<int>(std::floor(p.x() / kBin)), static_cast<int>(std::floor(p.y() / kBin)),
                              static_cast<int>(std::floor(p.z() / kBin))};
  };
  const auto free = [&](const Vec3& p, double distance) {
    const auto b = bin(p);
    const int reach = static_cast<int>(std::ceil(distance / kBin));
    for (int i = -reach; i <= reach; ++i) {
      for (int j = -reach; j <= reach; ++j) {
        for (int k = -reach; k <= reach; ++k) {
          const auto it = bins.find({b[0] + i, b[1] + j, b[2] + k});
          if (it == bins.end()) continue;
          for (const int n : it->second) {
            if ((kept[n].position - p).squaredNorm() < distance * distance) return false;
          }
        }
      }
    }
    return true;
  };
  std::vector<int> order(a.structures.size());
  for (std::size_t s = 0; s < order.size(); ++s) order[s] = static_cast<int>(s);
  std::stable_sort(order.begin(), order.end(), [&](int x, int y) {
    return a.structures[x].shape->inner_radius() < a.structures[y].shape->inner_radius();
  });
  for (const int s : order) {
    const Structure& structure = a.structures[s];
    Eigen::AlignedBox3d box = structure.shape->box();
    // Gives every structure a few seeds, however large the elements are.
    const double widest = 0.4 * box.sizes().maxCoeff();
    const double step = std::clamp(0.5 * structure.shape->inner_radius(), 1.0, 8.0);
    box.min().array() -= 1.5 * step;
    box.max().array() += 1.5 * step;
    std::array<int, 3> n{};
    for (int c = 0; c < 3; ++c) n[c] = static_cast<int>(std::ceil(box.sizes()[c] / step)) + 1;
    std::vector<int> labels(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
    const auto node = [&](int i, int j, int k) { return Vec3(box.min() + step * Vec3(i, j, k)); };
    const auto at = [&](int i, int j, int k) { return (static_cast<std::size_t>(k) * n[1] + j) * n[0] + i; };
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        for (int i = 0; i < n[0]; ++i) labels[at(i, j, k)] = a.label(node(i, j, k));
      }
    }
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        for (int i = 0; i < n[0]; ++i) {
          const int here = labels[at(i, j, k)];
          for (int axis = 0; axis < 3; ++axis) {
            const std::array<int, 3> c{i + (axis == 0), j + (axis == 1), k + (axis == 2)};
            if (c[axis] >= n[axis]) continue;
            const int there = labels[at(c[0], c[1], c[2])];
            if (here == there || (here != s + 1 && there != s + 1)) continue;
            const SurfaceSeed seed = cut(a, node(i, j, k), here, node(c[0], c[1], c[2]), there);
            const double distance = std::min(spacing * size(seed.position, scale), widest);
            if (!free(seed.position, distance)) continue;
            bins[bin(seed.position)].push_back(static_cast<int>(kept.size()));
            kept.push_back(seed);
          }
        }
      }
    }
  }
  return kept;
}

}  // namespace stylet::meshing
