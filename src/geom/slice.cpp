// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/slice.hpp"

#include "stylet/geom/topology.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {

/// Number of the edge between two local vertices.
constexpr std::array<std::array<int, 4>, 4> kEdge{{{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}}};

/// The two vertices named first in front of the plane, the others behind; even permutations, so that the quadrilateral
/// (0,2) (1,2) (1,3) (0,3) looks forward.
struct Pairs {
  unsigned front;
  std::array<int, 4> v;
};
constexpr std::array<Pairs, 6> kPairs{{{0b0011, {0, 1, 2, 3}},
                                       {0b0101, {0, 2, 3, 1}},
                                       {0b1001, {0, 3, 1, 2}},
                                       {0b0110, {1, 2, 0, 3}},
                                       {0b1010, {1, 3, 2, 0}},
                                       {0b1100, {2, 3, 0, 1}}}};

}  // namespace

Slicer::Slicer(const TetMesh& mesh) : mesh_(&mesh), tree_(mesh), tet_edges_(mesh.tets.size()) {
  using Edge = std::pair<Index, Index>;
  const auto edge = [&](std::size_t t, int i, int j) {
    const auto& tet = mesh.tets[t];
    return Edge(std::minmax(tet[static_cast<std::size_t>(i)], tet[static_cast<std::size_t>(j)]));
  };
  std::vector<Edge> edges;
  edges.reserve(6 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) edges.push_back(edge(t, i, j));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        const auto found = std::lower_bound(edges.begin(), edges.end(), edge(t, i, j));
        const auto number = static_cast<std::size_t>(kEdge[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
        tet_edges_[t][number] = static_cast<Index>(found - edges.begin());
      }
    }
  }
  height_.resize(mesh.nodes.size());
  node_slot_.assign(mesh.nodes.size(), -1);
  node_vertex_.assign(mesh.nodes.size(), -1);
  edge_vertex_.assign(edges.size(), -1);
  edges_cut_.reserve(edges.size());
  nodes_.reserve(mesh.nodes.size());
  vertices_.reserve(edges.size() + mesh.nodes.size());
  triangles_.reserve(2 * mesh.tets.size());
}

Index Slicer::node(Index of_mesh) {
  Index& slot = node_slot_[static_cast<std::size_t>(of_mesh)];
  if (slot < 0) {
    slot = static_cast<Index>(nodes_.size());
    nodes_.push_back(of_mesh);
  }
  return slot;
}

/// The plane's point on the edge from a local vertex in front to one behind.
Index Slicer::vertex(std::size_t tet, int above, int below) {
  const auto& corners = mesh_->tets[tet];
  Index a = corners[static_cast<std::size_t>(above)];
  Index b = corners[static_cast<std::size_t>(below)];
  if (height_[static_cast<std::size_t>(a)] == 0.0) {
    Index& at_node = node_vertex_[static_cast<std::size_t>(a)];
    if (at_node < 0) {
      at_node = static_cast<Index>(vertices_.size());
      const Index slot = node(a);
      vertices_.push_back({slot, slot, 0.0F});
    }
    return at_node;
  }
  const Index edge =
      tet_edges_[tet]
                [static_cast<std::size_t>(kEdge[static_cast<std::size_t>(above)][static_cast<std::size_t>(below)])];
  Index& on_edge = edge_vertex_[static_cast<std::size_t>(edge)];
  if (on_edge < 0) {
    on_edge = static_cast<Index>(vertices_.size());
    edges_cut_.push_back(edge);
    if (a > b) std::swap(a, b);  // the same numbers whichever element comes first
    const double height_a = height_[static_cast<std::size_t>(a)];
    const double height_b = height_[static_cast<std::size_t>(b)];
    const Index slot_a = node(a);
    const Index slot_b = node(b);
    vertices_.push_back({slot_a, slot_b, static_cast<float>(height_a / (height_a - height_b))});
  }
  return on_edge;
}

void Slicer::add(std::size_t tet, Index a, Index b, Index c) {
  if (a == b || b == c || c == a) return;  // the plane only touches this element, or a corner of it
  triangles_.push_back({{a, b, c}, static_cast<Index>(tet), mesh_->tet_region[tet]});
}

void Slicer::cut(const Vec3& origin, const Vec3& normal) {
  for (const Index edge : edges_cut_) edge_vertex_[static_cast<std::size_t>(edge)] = -1;
  for (const Index n : nodes_) {
    node_slot_[static_cast<std::size_t>(n)] = -1;
    node_vertex_[static_cast<std::size_t>(n)] = -1;
  }
  edges_cut_.clear();
  nodes_.clear();
  vertices_.clear();
  triangles_.clear();
  tree_.visit(
      [&](const Eigen::AlignedBox3d& box) {
        return std::abs(normal.dot(box.center() - origin)) <= 0.5 * normal.cwiseAbs().dot(box.sizes());
      },
      [&](std::span<const Index> tets) {
        for (const Index t : tets) {
          for (const Index n : mesh_->tets[static_cast<std::size_t>(t)]) {
            height_[static_cast<std::size_t>(n)] = normal.dot(mesh_->nodes[static_cast<std::size_t>(n)] - origin);
          }
          cut(static_cast<std::size_t>(t));
        }
        return true;
      });
}

/// The plane through one element.
void Slicer::cut(std::size_t t) {
  const auto& tet = mesh_->tets[t];
  unsigned front = 0;
  for (std::size_t i = 0; i < 4; ++i) front |= height_[static_cast<std::size_t>(tet[i])] >= 0.0 ? 1U << i : 0U;
  if (front == 0 || front == 0b1111) return;
  if (const auto pairs = std::find_if(kPairs.begin(), kPairs.end(), [&](const Pairs& p) { return p.front == front; });
      pairs != kPairs.end()) {
    const auto& v = pairs->v;
    const Index one = vertex(t, v[0], v[2]);
    const Index two = vertex(t, v[1], v[2]);
    const Index three = vertex(t, v[1], v[3]);
    const Index four = vertex(t, v[0], v[3]);
    add(t, one, two, three);
    add(t, one, three, four);
    return;
  }
  for (int i = 0; i < 4; ++i) {  // one vertex alone on its side
    const bool alone_in_front = front == 1U << i;
    if (!alone_in_front && front != (0b1111U ^ (1U << i))) continue;
    const auto& o = kFaceVertices[static_cast<std::size_t>(i)];
    if (alone_in_front) {
      const Index one = vertex(t, i, o[0]);
      const Index two = vertex(t, i, o[2]);
      add(t, one, two, vertex(t, i, o[1]));
    } else {
      const Index one = vertex(t, o[0], i);
      const Index two = vertex(t, o[1], i);
      add(t, one, two, vertex(t, o[2], i));
    }
  }
}

void Slicer::positions(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement, Eigen::Ref<Eigen::Matrix3Xf> out) const {
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    const SliceVertex& v = vertices_[k];
    const auto at = [&](Index slot) -> Eigen::Vector3f {
      const Vec3& x = mesh_->nodes[static_cast<std::size_t>(nodes_[static_cast<std::size_t>(slot)])];
      return x.cast<float>() + displacement.col(slot);
    };
    out.col(static_cast<Eigen::Index>(k)) = (1.0F - v.t) * at(v.a) + v.t * at(v.b);
  }
}

}  // namespace stylet
