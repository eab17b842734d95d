// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/element.hpp"
#include "stylet/fem/material.hpp"
#include "stylet/fem/shape.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <functional>
#include <memory>
#include <span>

namespace stylet::detail {

/// A kind of finite element on a tetrahedral mesh: its displacement nodes, its interpolation, and its stiffness as a
/// sum of small matrices. Supports are not taken into account here.
class Discretisation {
 public:
  using MaterialOf = std::function<Material(Index tet)>;
  /// Receives a symmetric matrix [N/mm] (3k × 3k) between k nodes; only the lower triangle of blocks is valid.
  using Add = std::function<void(std::span<const Index> nodes, const Eigen::Ref<const MatX>& K)>;
  using Visit = std::function<void(std::span<const Index> nodes)>;

  /// @param mesh must outlive the discretisation
  static std::unique_ptr<Discretisation> make(Element element, const TetMesh& mesh);

  virtual ~Discretisation() = default;

  [[nodiscard]] virtual Index nodes() const = 0;
  /// The two mesh nodes whose middle is a node; for a node of the mesh, twice that node.
  [[nodiscard]] virtual std::array<Index, 2> ends(Index node) const = 0;
  [[nodiscard]] virtual std::span<const Index> nodes_of(Index tet) const = 0;
  [[nodiscard]] virtual Shape shape(Index tet, const Vec4& weights) const = 0;
  [[nodiscard]] virtual ShapeGradients shape_gradients(Index tet, const Vec4& weights) const = 0;

  /// Passes the stiffness of the elements `tets` alone to `add`, in parts, always in the same order.
  virtual void stiffness(std::span<const Index> tets, const MaterialOf& material, const Add& add) const = 0;
  /// Passes the nodes of each of these parts to `visit`.
  virtual void parts(std::span<const Index> tets, const MaterialOf& material, const Visit& visit) const = 0;

  /// Stress at the centroid of every element of the mesh: xx yy zz xy yz zx [MPa] (6 × tets).
  /// @param u [mm] (3 × nodes)
  [[nodiscard]] virtual MatX stress(const MaterialOf& material, const VecX& u) const = 0;

  /// K u for the whole mesh with no node held [N] (3 × nodes). Only rows of nodes with `wanted` (nodes) are computed.
  [[nodiscard]] virtual VecX forces(const MaterialOf& material, const VecX& u,
                                    const std::vector<char>& wanted) const = 0;
};

}  // namespace stylet::detail
