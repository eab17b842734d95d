// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_tree.hpp"

#include <span>

namespace stylet {

/// A corner of a slice, on an edge of the mesh: x = (1 − t) x_a + t x_b. a and b are positions in Slicer::nodes().
/// Where the plane passes through a node, a = b = that node.
struct SliceVertex {
  Index a = 0;
  Index b = 0;
  float t = 0.0F;
};

/// A triangle of a slice: the part of the slice within one element, or half of that part if it is a quadrilateral. Its
/// corners are counter-clockwise when the plane's normal points to the viewer.
struct SliceTriangle {
  std::array<Index, 3> vertices{};  ///< positions in Slicer::vertices()
  Index tet = -1;                   ///< the element
  int region = -1;
};

/// Cuts the undeformed mesh by planes, one after the other. Points of the slice can then be moved with the material,
/// see positions(). Every edge has at most one vertex, so neighbouring triangles share their vertices. A node on the
/// plane counts as in front of it: therefore a face in the plane appears once, and an element that only touches the
/// plane does not appear.
///
/// The constructor allocates for the largest possible slice; cut() does not allocate. Not safe for use by several
/// threads at once.
class Slicer {
 public:
  explicit Slicer(const TetMesh& mesh);

  /// @param origin [mm] LPS, a point on the plane
  /// @param normal of any length, not zero
  void cut(const Vec3& origin, const Vec3& normal);

  [[nodiscard]] std::span<const Index> nodes() const { return nodes_; }  ///< nodes of the mesh that determine the slice
  [[nodiscard]] std::span<const SliceVertex> vertices() const { return vertices_; }
  [[nodiscard]] std::span<const SliceTriangle> triangles() const { return triangles_; }

  /// Positions of the slice's vertices [mm] LPS (3 × vertices) for a displaced mesh. Does not allocate.
  /// @param displacement [mm] displacements of nodes() (3 × nodes)
  /// @param out receives the positions
  void positions(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement, Eigen::Ref<Eigen::Matrix3Xf> out) const;

 private:
  /// An element of the mesh. Elements, nodes and edges are stored in the order of the tree, so that those near one
  /// plane are close together in memory.
  struct Element {
    std::array<Index, 4> nodes;
    std::array<Index, 6> edges;  ///< numbers of the edges between two of its vertices
    Index tet;
    int region;
  };
  /// A node of the mesh and its state in the current slice.
  struct Node {
    Vec3 x;  ///< [mm] LPS
    /// Normal · (x − origin), not divided by the normal's length; set for nodes of elements near the plane.
    double height = 0.0;
    Index of_mesh = -1;
    Index slot = -1;    ///< position in nodes_, -1 = none
    Index vertex = -1;  ///< vertex at this node, -1 = none
  };

  void cut(const Element& element);
  Index slot(Node& node);
  Index vertex(const Element& element, int above, int below);
  void add(const Element& element, Index a, Index b, Index c);

  TetTree tree_;
  std::vector<Element> elements_;
  std::vector<Node> corners_;       ///< (n)
  std::vector<Index> edge_vertex_;  ///< (edges) vertex on the edge, -1 = none
  std::vector<Index> edges_cut_;
  std::vector<Index> corner_of_slot_;  ///< (nodes_) position in corners_
  std::vector<Index> nodes_;
  std::vector<SliceVertex> vertices_;
  std::vector<SliceTriangle> triangles_;
};

}  // namespace stylet
