// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "discretisation.hpp"

namespace stylet::detail {

/// Quadratic tetrahedra with straight edges. Local nodes are the corners, then the middles of the edges 01 12 20 03 13
/// 23. Strain is linear within an element. @cite Hughes2000 ch. 3
class QuadraticTetrahedra final : public Discretisation {
 public:
  explicit QuadraticTetrahedra(const TetMesh& mesh);

  [[nodiscard]] Index nodes() const override { return mesh_.node_count() + static_cast<Index>(edges_.size()); }
  [[nodiscard]] std::array<Index, 2> ends(Index node) const override;
  [[nodiscard]] std::span<const Index> nodes_of(Index tet) const override { return nodes_[tet]; }
  [[nodiscard]] Shape shape(Index tet, const Vec4& weights) const override;
  [[nodiscard]] ShapeGradients shape_gradients(Index tet, const Vec4& weights) const override;
  void stiffness(std::span<const Index> tets, const MaterialOf& material, const Add& add) const override;
  void parts(std::span<const Index> tets, const MaterialOf& material, const Visit& visit) const override;
  [[nodiscard]] MatX stress(const MaterialOf& material, const VecX& u) const override;
  [[nodiscard]] VecX forces(const MaterialOf& material, const VecX& u, const std::vector<char>& wanted) const override;

 private:
  const TetMesh& mesh_;
  /// Ends of each edge, ascending; the node in the middle of edge e has the number n + e.
  std::vector<std::array<Index, 2>> edges_;
  std::vector<std::array<Index, kMostElementNodes>> nodes_;  ///< (m)
};

}  // namespace stylet::detail
