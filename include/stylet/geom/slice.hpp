// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_tree.hpp"

#include <span>

namespace stylet {

/// A corner of a slice, on an edge of the mesh: (1 − t) x_a + t x_b. a and b count Slicer::nodes(); where the plane
/// goes through a node they are that node, both.
struct SliceVertex {
  Index a = 0;
  Index b = 0;
  float t = 0.0F;
};

/// A piece of a slice, in one element; counter-clockwise seen against the plane's normal.
struct SliceTriangle {
  std::array<Index, 3> vertices{};  ///< of Slicer::vertices()
  Index tet = -1;
  int region = -1;
};

/// Cuts a mesh by planes, again and again: the mesh as it lies undeformed; points on the slice move with the material.
/// Every edge gives one vertex at most, so neighbouring triangles share theirs. A node on the plane counts as in front
/// of it: a face in the plane is taken once, an element that only touches it not at all.
///
/// Room for the largest slice there can be is taken at the start; cut() does not allocate. One thread at a time.
class Slicer {
 public:
  explicit Slicer(const TetMesh& mesh);

  /// @param origin [mm] LPS, a point on the plane
  /// @param normal not zero; any length
  void cut(const Vec3& origin, const Vec3& normal);

  [[nodiscard]] std::span<const Index> nodes() const { return nodes_; }  ///< of the mesh that the slice hangs on
  [[nodiscard]] std::span<const SliceVertex> vertices() const { return vertices_; }
  [[nodiscard]] std::span<const SliceTriangle> triangles() const { return triangles_; }

  /// Where the slice's vertices are when its nodes are displaced [mm] LPS (3 × vertices). Does not allocate.
  /// @param displacement [mm] (3 × nodes())
  void positions(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement, Eigen::Ref<Eigen::Matrix3Xf> out) const;

 private:
  /// Of the mesh, in the order of the tree, as are its nodes and edges: what a plane meets lies close together.
  struct Element {
    std::array<Index, 4> nodes;
    std::array<Index, 6> edges;  ///< between two local vertices
    Index tet;
    int region;
  };
  struct Node {
    Vec3 x;               ///< [mm] LPS
    double height = 0.0;  ///< along the normal, scaled by its length; of elements near the plane
    Index of_mesh = -1;
    Index slot = -1;    ///< in nodes_
    Index vertex = -1;  ///< at the node
  };

  void cut(const Element& element);
  Index slot(Node& node);
  Index vertex(const Element& element, int above, int below);
  void add(const Element& element, Index a, Index b, Index c);

  TetTree tree_;
  std::vector<Element> elements_;
  std::vector<Node> corners_;       ///< (n)
  std::vector<Index> edge_vertex_;  ///< (edges) vertex on an edge, -1
  std::vector<Index> edges_cut_;
  std::vector<Index> corner_of_slot_;  ///< (nodes_) number in corners_
  std::vector<Index> nodes_;
  std::vector<SliceVertex> vertices_;
  std::vector<SliceTriangle> triangles_;
};

}  // namespace stylet
