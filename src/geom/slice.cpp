// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/slice.hpp"

#include "stylet/geom/topology.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {

/// Number of the edge between two local vertices, -1 on the diagonal.
constexpr std::array<std::array<int, 4>, 4> kEdge{{{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}}};

/// Elements of which two vertices are in front of the plane and two behind. `v` lists the vertices in front first. Its
/// permutations are even, so the quadrilateral (0,2) (1,2) (1,3) (0,3) faces forwards.
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

Slicer::Slicer(const TetMesh& mesh) : tree_(mesh) {
  std::vector<Index> number_of_node(mesh.nodes.size(), -1);
  corners_.reserve(mesh.nodes.size());
  // Its two nodes, the number of an element that has it, and its number in that element.
  using Edge = std::array<Index, 4>;
  std::vector<Edge> edges;
  edges.reserve(6 * mesh.tets.size());
  elements_.reserve(mesh.tets.size());
  for (const Index t : tree_.order()) {
    Element element{{}, {}, t, mesh.tet_region[static_cast<std::size_t>(t)]};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto of_mesh = static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(t)][i]);
      if (number_of_node[of_mesh] < 0) {
        number_of_node[of_mesh] = static_cast<Index>(corners_.size());
        corners_.push_back({mesh.nodes[of_mesh], 0.0, static_cast<Index>(of_mesh)});
      }
      element.nodes[i] = number_of_node[of_mesh];
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const auto [a, b] = std::minmax(element.nodes[i], element.nodes[j]);
        edges.push_back({a, b, static_cast<Index>(elements_.size()), kEdge[i][j]});
      }
    }
    elements_.push_back(element);
  }
  std::sort(edges.begin(), edges.end());
  Index edge = -1;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [a, b, element, within] = edges[e];
    if (e == 0 || a != edges[e - 1][0] || b != edges[e - 1][1]) ++edge;
    elements_[static_cast<std::size_t>(element)].edges[static_cast<std::size_t>(within)] = edge;
  }
  const auto edge_count = static_cast<std::size_t>(edge + 1);
  edge_vertex_.assign(edge_count, -1);
  edges_cut_.reserve(edge_count);
  nodes_.reserve(corners_.size());
  corner_of_slot_.reserve(corners_.size());
  vertices_.reserve(edge_count + corners_.size());
  triangles_.reserve(2 * elements_.size());
}

Index Slicer::slot(Node& node) {
  if (node.slot < 0) {
    node.slot = static_cast<Index>(nodes_.size());
    nodes_.push_back(node.of_mesh);
    corner_of_slot_.push_back(static_cast<Index>(&node - corners_.data()));
  }
  return node.slot;
}

/// The vertex on the edge from a local vertex in front of the plane to one behind it.
Index Slicer::vertex(const Element& element, int above, int below) {
  Index a = element.nodes[static_cast<std::size_t>(above)];
  Index b = element.nodes[static_cast<std::size_t>(below)];
  if (Node& on_plane = corners_[static_cast<std::size_t>(a)]; on_plane.height == 0.0) {
    if (on_plane.vertex < 0) {
      on_plane.vertex = static_cast<Index>(vertices_.size());
      const Index only = slot(on_plane);
      vertices_.push_back({only, only, 0.0F});
    }
    return on_plane.vertex;
  }
  const Index edge =
      element.edges[static_cast<std::size_t>(kEdge[static_cast<std::size_t>(above)][static_cast<std::size_t>(below)])];
  Index& on_edge = edge_vertex_[static_cast<std::size_t>(edge)];
  if (on_edge < 0) {
    on_edge = static_cast<Index>(vertices_.size());
    edges_cut_.push_back(edge);
    if (a > b) std::swap(a, b);  // interpolate in the same order, whichever element is processed first
    Node& from = corners_[static_cast<std::size_t>(a)];
    Node& to = corners_[static_cast<std::size_t>(b)];
    const Index slot_a = slot(from);
    const Index slot_b = slot(to);
    vertices_.push_back({slot_a, slot_b, static_cast<float>(from.height / (from.height - to.height))});
  }
  return on_edge;
}

void Slicer::add(const Element& element, Index a, Index b, Index c) {
  if (a == b || b == c || c == a) return;  // the plane only touches this element or one of its corners
  triangles_.push_back({{a, b, c}, element.tet, element.region});
}

void Slicer::cut(const Vec3& origin, const Vec3& normal) {
  for (const Index edge : edges_cut_) edge_vertex_[static_cast<std::size_t>(edge)] = -1;
  for (const Index corner : corner_of_slot_) {
    corners_[static_cast<std::size_t>(corner)].slot = -1;
    corners_[static_cast<std::size_t>(corner)].vertex = -1;
  }
  edges_cut_.clear();
  corner_of_slot_.clear();
  nodes_.clear();
  vertices_.clear();
  triangles_.clear();
  tree_.visit(
      [&](const Eigen::AlignedBox3d& box) {
        return std::abs(normal.dot(box.center() - origin)) <= 0.5 * normal.cwiseAbs().dot(box.sizes());
      },
      [&](std::span<const Index> tets) {
        const auto first = static_cast<std::size_t>(tets.data() - tree_.order().data());
        for (const Element& element : std::span(elements_).subspan(first, tets.size())) {
          for (const Index n : element.nodes) {
            Node& node = corners_[static_cast<std::size_t>(n)];
            node.height = normal.dot(node.x - origin);
          }
          cut(element);
        }
        return true;
      });
}

/// Cuts one element by the current plane.
void Slicer::cut(const Element& element) {
  unsigned front = 0;
  for (std::size_t i = 0; i < 4; ++i)
    front |= corners_[static_cast<std::size_t>(element.nodes[i])].height >= 0.0 ? 1U << i : 0U;
  if (front == 0 || front == 0b1111) return;
  if (const auto pairs = std::find_if(kPairs.begin(), kPairs.end(), [&](const Pairs& p) { return p.front == front; });
      pairs != kPairs.end()) {
    const auto& v = pairs->v;
    const Index one = vertex(element, v[0], v[2]);
    const Index two = vertex(element, v[1], v[2]);
    const Index three = vertex(element, v[1], v[3]);
    const Index four = vertex(element, v[0], v[3]);
    add(element, one, two, three);
    add(element, one, three, four);
    return;
  }
  for (int i = 0; i < 4; ++i) {  // one vertex is alone on its side of the plane
    const bool alone_in_front = front == 1U << i;
    if (!alone_in_front && front != (0b1111U ^ (1U << i))) continue;
    const auto& o = kFaceVertices[static_cast<std::size_t>(i)];
    if (alone_in_front) {
      const Index one = vertex(element, i, o[0]);
      const Index two = vertex(element, i, o[2]);
      add(element, one, two, vertex(element, i, o[1]));
    } else {
      const Index one = vertex(element, o[0], i);
      const Index two = vertex(element, o[1], i);
      add(element, one, two, vertex(element, o[2], i));
    }
  }
}

void Slicer::positions(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement, Eigen::Ref<Eigen::Matrix3Xf> out) const {
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    const SliceVertex& v = vertices_[k];
    const auto at = [&](Index slot) -> Eigen::Vector3f {
      const Vec3& x = corners_[static_cast<std::size_t>(corner_of_slot_[static_cast<std::size_t>(slot)])].x;
      return x.cast<float>() + displacement.col(slot);
    };
    out.col(static_cast<Eigen::Index>(k)) = (1.0F - v.t) * at(v.a) + v.t * at(v.b);
  }
}

}  // namespace stylet
