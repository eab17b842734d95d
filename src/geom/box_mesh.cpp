// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <random>

namespace stylet {
namespace {

// The six orders in which a path along the edges of a cell can take its steps along x, y and z. An odd permutation
// gives a tetrahedron of negative volume, so two of its corners are exchanged.
struct KuhnPath {
  std::array<int, 3> axes;
  bool odd;
};
constexpr std::array<KuhnPath, 6> kPaths{{{{0, 1, 2}, false},
                                          {{0, 2, 1}, true},
                                          {{1, 0, 2}, true},
                                          {{1, 2, 0}, false},
                                          {{2, 0, 1}, false},
                                          {{2, 1, 0}, true}}};

}  // namespace

TetMesh box_mesh(const Vec3& lo, const Vec3& hi, std::array<int, 3> cells, double jitter) {
  assert(((hi - lo).array() > 0.0).all());
  for (int& count : cells) count = std::max(count, 1);
  jitter = std::clamp(jitter, 0.0, 0.15);

  TetMesh mesh;
  mesh.regions = {"body"};
  const std::array<int, 3> points{cells[0] + 1, cells[1] + 1, cells[2] + 1};
  const auto node = [&](int i, int j, int k) { return static_cast<Index>(i + points[0] * (j + points[1] * k)); };
  const Vec3 cell = (hi - lo).cwiseQuotient(Vec3(cells[0], cells[1], cells[2]));

  // The standard specifies the output of std::mt19937 but not that of its distributions, so the numbers are mapped
  // here.
  std::mt19937 random(1960);
  const auto symmetric = [&random] { return 2.0 * (static_cast<double>(random()) + 0.5) / 4294967296.0 - 1.0; };

  mesh.nodes.reserve(static_cast<std::size_t>(points[0]) * points[1] * points[2]);
  for (int k = 0; k < points[2]; ++k) {
    for (int j = 0; j < points[1]; ++j) {
      for (int i = 0; i < points[0]; ++i) {
        // Assigning `hi` makes the last grid plane exact; lo plus a rounded product might differ in the last bit.
        Vec3 x(i == cells[0] ? hi.x() : lo.x() + i * cell.x(), j == cells[1] ? hi.y() : lo.y() + j * cell.y(),
               k == cells[2] ? hi.z() : lo.z() + k * cell.z());
        const bool inside = i > 0 && i < cells[0] && j > 0 && j < cells[1] && k > 0 && k < cells[2];
        if (inside && jitter > 0.0) {
          for (int axis = 0; axis < 3; ++axis) x[axis] += jitter * cell[axis] * symmetric();
        }
        mesh.nodes.push_back(x);
      }
    }
  }

  mesh.tets.reserve(6 * static_cast<std::size_t>(cells[0]) * cells[1] * cells[2]);
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        for (const KuhnPath& path : kPaths) {
          std::array<int, 3> corner{i, j, k};
          std::array<Index, 4> tet{node(i, j, k), 0, 0, 0};
          for (int step = 0; step < 3; ++step) {
            ++corner[path.axes[step]];
            tet[step + 1] = node(corner[0], corner[1], corner[2]);
          }
          if (path.odd) std::swap(tet[1], tet[2]);
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  mesh.tet_region.assign(mesh.tets.size(), 0);
  return mesh;
}

void assign_regions(TetMesh& mesh, std::vector<std::string> regions, const std::function<int(const Vec3&)>& region_at) {
  mesh.regions = std::move(regions);
  mesh.tet_region.resize(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 centroid = Vec3::Zero();
    for (const Index a : mesh.tets[t]) centroid += 0.25 * mesh.nodes[a];
    mesh.tet_region[t] = region_at(centroid);
  }
}

}  // namespace stylet
