// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <span>
#include <vector>

namespace stylet {

/// Stiffness of a few elements cut out of the mesh. Only the nodes with given displacements hold them. The matrix is
/// dense: meant for patches of some hundred nodes. An object may be used for one patch after another, and keeps its
/// memory; it allocates, so it is not for a step.
class Patch {
 public:
  /// Assembles the stiffness of the elements `tets` alone, as if all were of one material, with the tissue's kind of
  /// element. Supports of the tissue have no effect other than through `moves`.
  /// @param tets numbers of tetrahedra of the tissue's mesh, each at most once
  /// @param nodes displacement nodes of these elements, ascending (p)
  /// @param moves (p) whether a node moves; moving nodes, and the others, keep their order
  void assemble(const Tissue& tissue, std::span<const Index> tets, std::span<const Index> nodes,
                const std::vector<char>& moves, const Material& material);

  /// (p) Displacement nodes of the elements: first the nodes that move, then the others.
  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
  /// Number m of nodes that move.
  [[nodiscard]] Index moving() const { return moving_; }
  /// [N/mm] (3m × 3p) rows of the stiffness for the nodes that move, columns in the order of nodes(). Of the block of
  /// the nodes that move only the lower triangle is valid.
  [[nodiscard]] Eigen::Map<const MatX> K() const {
    return {K_.data(), 3 * Eigen::Index{moving_}, 3 * static_cast<Eigen::Index>(nodes_.size())};
  }

  /// Solves for the displacements of the nodes that move.
  /// @param given [mm] displacements of the other nodes (3(p − m) × loads)
  /// @param forces [N] on the nodes that move (3m × loads)
  /// @return [mm] (3m × loads)
  [[nodiscard]] MatX displacements(const MatX& given, MatX forces);

 private:
  std::vector<Index> nodes_;
  Index moving_ = 0;
  std::vector<double> K_;
  std::vector<double> factor_;      ///< work space of displacements()
  std::vector<Eigen::Index> row_;   ///< (p) first row of each node in the given order
  std::vector<Eigen::Index> rows_;  ///< work space: first rows of the nodes of a part
};

}  // namespace stylet
