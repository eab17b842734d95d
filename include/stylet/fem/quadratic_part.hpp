// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/fem/tissue.hpp"

#include <Eigen/SparseCore>

#include <functional>
#include <memory>
#include <vector>

namespace stylet {

/// Elements of a tissue as a body of their own: made quadratic, and held at the rim where they meet the other elements.
/// Forces inside displace the tissue by static condensation: the body with its rim held, plus the whole mesh under the
/// forces that the body exerts on its rim.
class QuadraticPart {
 public:
  /// @param whole linear elements
  /// @param is_near whether a place [mm] LPS is in the part; elements with such a corner belong to it
  /// Errors: those of Tissue::build().
  static Result<QuadraticPart> build(const Tissue& whole, const std::function<bool(const Vec3&)>& is_near);

  /// Number in the part of an element of the whole mesh, or −1.
  [[nodiscard]] Index number(Index tet) const { return number_[static_cast<std::size_t>(tet)]; }
  /// Number in the whole mesh of a node of the part's mesh.
  [[nodiscard]] Index node_of_whole(Index node) const { return node_[static_cast<std::size_t>(node)]; }
  /// Whether a node of the whole mesh is in the part, its rim included.
  [[nodiscard]] bool has_node(Index node_of_whole) const {
    return has_node_[static_cast<std::size_t>(node_of_whole)] != 0;
  }
  [[nodiscard]] const Tissue& tissue() const { return *tissue_; }

  /// Adds the forces of the part on its rim, for any number of columns.
  /// @param loads [N] (3 × displacement nodes of the part) @param u [mm] their displacement, with the rim held
  /// @param on_whole [N] (3 × displacement nodes of the whole tissue)
  void add_rim_forces(const MatX& loads, const MatX& u, MatX& on_whole) const;

  /// The displacement [mm] (3 × displacement nodes of the part) when the rim goes where the whole mesh takes it and no
  /// forces act inside, for any number of columns.
  /// @param of_whole [mm] (3 × displacement nodes of the whole tissue)
  [[nodiscard]] MatX with_rim_moved(const MatX& of_whole) const;

 private:
  void couple_rim();

  std::vector<Index> number_;   ///< (elements of the whole mesh)
  std::vector<Index> node_;     ///< (nodes of the part's mesh)
  std::vector<char> has_node_;  ///< (nodes of the whole mesh)
  std::unique_ptr<Tissue> tissue_;
  /// [N/mm] (3 × displacement nodes, twice) forces on nodes that can move per displacement of the rim
  Eigen::SparseMatrix<double> coupling_;
};

}  // namespace stylet
