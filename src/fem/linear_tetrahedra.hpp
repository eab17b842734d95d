// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "discretisation.hpp"

namespace stylet::detail {

/// Linear tetrahedra: constant strain, and no nodes besides those of the mesh. @cite Hughes2000 ch. 2
class LinearTetrahedra : public Discretisation {
 public:
  explicit LinearTetrahedra(const TetMesh& mesh) : mesh_(mesh) {}

  [[nodiscard]] Index nodes() const final { return mesh_.node_count(); }
  [[nodiscard]] std::array<Index, 2> ends(Index node) const final { return {node, node}; }
  [[nodiscard]] std::span<const Index> nodes_of(Index tet) const final { return mesh_.tets[tet]; }
  [[nodiscard]] Shape shape(Index tet, const Vec4& weights) const final;
  [[nodiscard]] ShapeGradients shape_gradients(Index tet, const Vec4& weights) const final;
  void stiffness(std::span<const Index> tets, const MaterialOf& material, const Add& add) const override;
  void parts(std::span<const Index> tets, const MaterialOf& material, const Visit& visit) const override;
  [[nodiscard]] MatX stress(const MaterialOf& material, const VecX& u) const override;
  [[nodiscard]] VecX forces(const MaterialOf& material, const VecX& u, const std::vector<char>& wanted) const final;

 protected:
  /// Displacement gradient ∂u/∂X in an element (3×3).
  [[nodiscard]] Mat3 gradient(Index tet, const VecX& u) const;

  const TetMesh& mesh_;
};

}  // namespace stylet::detail
