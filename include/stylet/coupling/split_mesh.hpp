// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"

#include <optional>
#include <span>
#include <vector>

namespace stylet {

/// The tissue mesh with nodes added inside some of its elements. Base nodes keep their numbers; added node k has the
/// number base nodes + k. Split elements form a forest: each base tetrahedron is a root, and the elements that a split
/// makes are its children. Only reset() undoes splits. No call after construction allocates.
class SplitMesh {
 public:
  /// @param locator of the base mesh; must outlive this object
  /// @param capacity largest number of added nodes
  SplitMesh(const Locator& locator, int capacity);

  /// An unsplit tetrahedron of the current mesh.
  struct Leaf {
    std::array<Index, 4> vertices{-1, -1, -1, -1};
    Index base_tet = -1;  ///< base tetrahedron that contains it, which has its region and material
    Index cell = -1;      ///< place in the forest, −1: the leaf is the base tetrahedron itself
  };

  /// The leaf of base tetrahedron `base_tet` that contains x [mm].
  [[nodiscard]] Leaf leaf_at(Index base_tet, const Vec3& x) const;

  /// Barycentric weights of x in a leaf (4).
  [[nodiscard]] Vec4 weights(const Leaf& leaf, const Vec3& x) const;

  /// Gradients of a leaf's barycentric coordinates [1/mm] (3×4).
  [[nodiscard]] Eigen::Matrix<double, 3, 4> gradients(const Leaf& leaf) const;
  [[nodiscard]] double volume(const Leaf& leaf) const;  ///< [mm³]

  /// A leaf that a new node splits, and the node's place in it.
  struct Part {
    Leaf leaf;
    Vec4 weights = Vec4::Zero();  ///< barycentric weights of the node in the leaf, sum 1
    int opposite = -1;            ///< local number of the vertex opposite the face that the node is on (its weight is
                                  ///< 0); −1: inside
  };
  /// A place for a new node: inside a leaf, or on the face between two leaves (at the outer surface, of one leaf).
  struct Place {
    Vec3 x = Vec3::Zero();  ///< [mm] LPS
    std::array<Part, 2> part{};
    int count = 0;  ///< number of leaves that are split

    [[nodiscard]] bool inside() const { return part.front().opposite < 0; }
    [[nodiscard]] std::span<const Part> parts() const { return std::span(part).first(static_cast<std::size_t>(count)); }
  };
  /// The place inside the leaf of `base_tet` that contains x. Empty where a weight is less than `smallest`.
  [[nodiscard]] std::optional<Place> place_inside(Index base_tet, const Vec3& x, double smallest) const;
  /// The place on the face that a path through x along `travel` crosses at x. The leaf that the path leaves comes
  /// first; at the outer surface there is only one leaf. Empty where there is no such face, or a weight on it is less
  /// than `smallest`.
  /// @param base_tet a base tetrahedron that the face belongs to
  [[nodiscard]] std::optional<Place> place_on_face(Index base_tet, const Vec3& x, const Vec3& travel,
                                                   double smallest) const;

  /// Adds a node: a leaf becomes four leaves if the node is inside, three if it is on a face.
  /// @return the number of the new node, or −1 when the capacity is used up
  Index split(const Place& place);

  [[nodiscard]] Vec3 position(Index vertex) const;  ///< [mm] LPS, of a base node or an added node
  [[nodiscard]] bool is_added(Index vertex) const { return vertex >= base_nodes_; }
  [[nodiscard]] int added(Index vertex) const {
    return vertex - base_nodes_;
  }  ///< number among the added nodes, from 0
  [[nodiscard]] int added_count() const { return static_cast<int>(positions_.size()); }
  [[nodiscard]] const Locator& locator() const { return *locator_; }

  /// Restores the base mesh exactly.
  void reset();

  /// The present mesh as a mesh of its own. Allocates; for checks against a new factorisation and for pictures.
  [[nodiscard]] TetMesh materialise() const;

 private:
  struct Cell {
    std::array<Index, 4> vertices{};
    Index base_tet = -1;
    Index first_child = -1;
    int children = 0;
  };
  Index cell_of(const Leaf& leaf);
  void split_cell(Index cell, Index vertex, int skip);

  const Locator* locator_;
  Index base_nodes_;
  std::size_t capacity_;
  std::vector<Vec3> positions_;  ///< [mm] LPS, of the added nodes
  std::vector<Cell> cells_;
  std::vector<Index> root_;        ///< (base tets) cell of a split base tetrahedron, −1: not split
  std::vector<Index> split_tets_;  ///< base tetrahedra that reset() has to restore
};

}  // namespace stylet
