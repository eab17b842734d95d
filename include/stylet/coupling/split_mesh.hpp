// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"

#include <vector>

namespace stylet {

/// The tissue mesh with nodes added inside some of its elements. Base nodes keep their numbers; added node k has number
/// base nodes + k. Elements are split as a forest: a base tetrahedron, its children, their children, … Nothing is ever
/// merged again except by reset(). No call after construction allocates.
class SplitMesh {
 public:
  /// @param locator base mesh; must outlive this
  /// @param capacity largest number of added nodes
  SplitMesh(const Locator& locator, int capacity);

  /// An unsplit tetrahedron of the current mesh.
  struct Leaf {
    std::array<Index, 4> vertices{-1, -1, -1, -1};
    Index base_tet = -1;  ///< base tetrahedron it lies in (its region and material)
    Index cell = -1;      ///< position in the forest, -1 = the base tetrahedron itself
  };

  /// The leaf of base tetrahedron `base_tet` that contains x.
  [[nodiscard]] Leaf leaf_at(Index base_tet, const Vec3& x) const;

  /// Barycentric weights of x in a leaf (4).
  [[nodiscard]] Vec4 weights(const Leaf& leaf, const Vec3& x) const;

  /// Gradients of a leaf's barycentric coordinates [1/mm] (3×4).
  [[nodiscard]] Eigen::Matrix<double, 3, 4> gradients(const Leaf& leaf) const;
  [[nodiscard]] double volume(const Leaf& leaf) const;  ///< [mm³]

  /// Splits a leaf into four at an interior point. Returns the new node's number, or -1 when the capacity is used up.
  Index split_inside(const Leaf& leaf, const Vec3& x);

  /// Splits the two leaves that share a face (one at the outer surface: pass a second leaf with base_tet = -1) into
  /// three each at a point on that face. @param local1, local2 the vertex opposite the face in each leaf
  Index split_face(const Leaf& one, int local1, const Leaf& two, int local2, const Vec3& x);

  [[nodiscard]] Vec3 position(Index vertex) const;  ///< [mm] LPS, base or added
  [[nodiscard]] bool is_added(Index vertex) const { return vertex >= base_nodes_; }
  [[nodiscard]] int added(Index vertex) const { return vertex - base_nodes_; }  ///< 0-based number among added nodes
  [[nodiscard]] int added_count() const { return static_cast<int>(positions_.size()); }
  [[nodiscard]] const Locator& locator() const { return *locator_; }

  /// Back to the base mesh, exactly.
  void reset();

  /// The current mesh written out (allocates; for checks against a refactorised mesh and for display).
  [[nodiscard]] TetMesh materialise() const;

 private:
  struct Cell {
    std::array<Index, 4> vertices{};
    Index base_tet = -1;
    Index first_child = -1;
    int children = 0;
  };
  Index cell_of(const Leaf& leaf);
  void split(Index cell, Index vertex, int skip);

  const Locator* locator_;
  Index base_nodes_;
  std::size_t capacity_;
  std::vector<Vec3> positions_;  ///< of added nodes
  std::vector<Cell> cells_;
  std::vector<Index> root_;        ///< (base tets) cell of a split base tetrahedron, -1 unsplit
  std::vector<Index> split_tets_;  ///< base tetrahedra to restore on reset
};

}  // namespace stylet
