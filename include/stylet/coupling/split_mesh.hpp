// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"

#include <optional>
#include <span>
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

  /// A leaf that a new node splits.
  struct Part {
    Leaf leaf;
    Vec4 weights = Vec4::Zero();  ///< of the node in it, sum 1
    int opposite = -1;            ///< vertex opposite the face that the node is on, its weight 0; -1 = inside
  };
  /// Where a node can be added: inside a leaf, or on the face of two (one at the outer surface).
  struct Place {
    Vec3 x = Vec3::Zero();  ///< [mm] LPS
    std::array<Part, 2> part{};
    int count = 0;  ///< leaves that are split

    [[nodiscard]] bool inside() const { return part.front().opposite < 0; }
    [[nodiscard]] std::span<const Part> parts() const { return std::span(part).first(static_cast<std::size_t>(count)); }
  };
  /// A place inside the leaf of `base_tet` that contains x. Empty where a weight is less than `smallest`.
  [[nodiscard]] std::optional<Place> place_inside(Index base_tet, const Vec3& x, double smallest) const;
  /// A place on the face that a path through x along `travel` crosses there: the leaf that it leaves comes first, at
  /// the outer surface there is only one. Empty where there is no such face, or a weight on it is less than `smallest`.
  /// @param base_tet a base tetrahedron that the face belongs to
  [[nodiscard]] std::optional<Place> place_on_face(Index base_tet, const Vec3& x, const Vec3& travel,
                                                   double smallest) const;

  /// Adds a node: a leaf becomes four if the node is inside, three if it is on a face. Returns the new node's number,
  /// or -1 when the capacity is used up.
  Index split(const Place& place);

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
  void split_cell(Index cell, Index vertex, int skip);

  const Locator* locator_;
  Index base_nodes_;
  std::size_t capacity_;
  std::vector<Vec3> positions_;  ///< of added nodes
  std::vector<Cell> cells_;
  std::vector<Index> root_;        ///< (base tets) cell of a split base tetrahedron, -1 unsplit
  std::vector<Index> split_tets_;  ///< base tetrahedra to restore on reset
};

}  // namespace stylet
