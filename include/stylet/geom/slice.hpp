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
  /// @param mesh must outlive the slicer
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
  void cut(std::size_t tet);
  Index node(Index of_mesh);
  Index vertex(std::size_t tet, int above, int below);
  void add(std::size_t tet, Index a, Index b, Index c);

  const TetMesh* mesh_;
  TetTree tree_;
  std::vector<std::array<Index, 6>> tet_edges_;  ///< (m) number of the edge between two local vertices
  std::vector<double> height_;      ///< (n) along the normal, scaled by its length; of elements near the plane
  std::vector<Index> node_slot_;    ///< (n) in nodes_, -1
  std::vector<Index> node_vertex_;  ///< (n) vertex at a node, -1
  std::vector<Index> edge_vertex_;  ///< (edges) vertex on an edge, -1
  std::vector<Index> edges_cut_;
  std::vector<Index> nodes_;
  std::vector<SliceVertex> vertices_;
  std::vector<SliceTriangle> triangles_;
};

}  // namespace stylet
