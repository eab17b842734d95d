// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/fem/element.hpp"
#include "stylet/fem/material.hpp"
#include "stylet/fem/shape.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <Eigen/SparseCore>

#include <memory>
#include <span>

namespace stylet {

namespace detail {
class Discretisation;
}

/// Linear elastic, quasi-static tissue on tetrahedra, held at its fixed nodes:
///   K u = f,
/// with K symmetric positive definite on the free degrees of freedom and factorised once. Immutable after build();
/// several threads may read it at once.
class Tissue {
 public:
  /// Builds the tissue and factorises its stiffness.
  /// @param mesh a mesh that passes check_mesh(); kept by value
  /// @param materials one material per region of the mesh, in the same order
  /// @param fixed numbers of the mesh nodes held at zero displacement. They must exclude rigid motion of every
  ///   connected part, or the result is an error. A node that the kind of element adds between two fixed nodes is fixed
  ///   as well.
  /// @param element kind of finite element
  /// @param corridor nodes of the mesh for which compliance_of_corridor() gives the compliance
  static Result<Tissue> build(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                              const Progress& progress = {}, Element element = Element::p1,
                              const std::vector<Index>& corridor = {});

  /// Builds the tissue without factorising, for a tissue whose compliance is already known. The first call that needs
  /// the factor makes it, once, in whichever thread that call runs. If memory runs out then, that call throws
  /// std::bad_alloc.
  static Result<Tissue> build_later(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                                    Element element, const std::vector<Index>& corridor);

  Tissue(Tissue&&) noexcept;
  Tissue& operator=(Tissue&&) noexcept;
  ~Tissue();

  [[nodiscard]] const TetMesh& mesh() const;
  [[nodiscard]] Element element() const;

  /// Number n of nodes that carry displacements: the nodes of the mesh, with the mesh's numbers, followed by the nodes
  /// that the kind of element adds. In this class, "node" means one of these unless stated otherwise.
  [[nodiscard]] Index displacement_nodes() const;
  [[nodiscard]] Vec3 node_position(Index node) const;  ///< [mm] LPS, undeformed
  /// The two mesh nodes whose middle is a node; for a node of the mesh, twice that node.
  [[nodiscard]] std::array<Index, 2> ends_of(Index node) const;
  [[nodiscard]] std::span<const Index> nodes_of(Index tet) const;  ///< displacement nodes of an element

  /// Interpolation weights at a material point: a tetrahedron and the barycentric weights in it.
  [[nodiscard]] Shape shape(Index tet, const Vec4& weights) const;
  [[nodiscard]] ShapeGradients shape_gradients(Index tet, const Vec4& weights) const;

  [[nodiscard]] const Material& material(int region) const;
  [[nodiscard]] const std::vector<Material>& materials() const;
  [[nodiscard]] bool is_fixed(Index node) const;
  [[nodiscard]] const std::vector<Index>& fixed_nodes() const;  ///< numbers of all fixed displacement nodes, sorted

  /// Number of free degrees of freedom: 3 × number of displacement nodes that are not fixed.
  [[nodiscard]] Index free_dofs() const;
  /// First degree of freedom of a node, or -1 for a fixed node.
  [[nodiscard]] Index first_dof(Index node) const;

  /// Stiffness on the free degrees of freedom, both triangles stored [N/mm] (free × free).
  [[nodiscard]] const Eigen::SparseMatrix<double>& stiffness() const;

  /// Solves u = K⁻¹ f for one or several right-hand sides. Allocates; not to be called in a step.
  /// @param f [N] (3n × k) over all nodes; rows of fixed nodes are ignored
  /// @return [mm] (3n × k), zero at fixed nodes
  [[nodiscard]] MatX solve(const MatX& f) const;

  /// The nodes of the corridor that can move, in the order given to build(), followed by the nodes that the kind of
  /// element adds between two of them. Reading compliance is fastest when nodes that are used together are neighbours
  /// here.
  [[nodiscard]] const std::vector<Index>& corridor() const;

  /// K⁻¹ among the nodes of corridor(), in their order [mm/N] (3c × 3c), symmetric to the last bit. These nodes are
  /// eliminated last, so the result is the inverse of a dense block of the factor and needs no solve per node
  /// (docs/theory/tissue.md, Compliance). Allocates and takes O(c³) operations; call it once and keep the result.
  [[nodiscard]] MatX compliance_of_corridor(const Progress& progress = {}) const;

  /// Whether the factor has been made.
  [[nodiscard]] bool has_factor() const;

  /// Forces that the supports exert on the tissue [N] (3n), non-zero at fixed nodes only: the rows of K_full u for
  /// these nodes.
  [[nodiscard]] VecX support_forces(const VecX& u) const;

  /// Cauchy stress [MPa] (6 × tets) at the centroid of every element (constant within linear elements), in the order
  /// xx yy zz xy yz zx.
  /// @param u [mm] (3 × displacement nodes), or only (3 × mesh nodes). In the second case the displacements of the
  ///   nodes that quadratic elements add are unknown, and the stress is that of linear elements with averaged pressure.
  [[nodiscard]] MatX stress(const VecX& u) const;

  /// Size of the factor and time to make it, for reports.
  struct Statistics {
    double factor_seconds = 0;
    double factor_mb = 0;
    Index factor_entries = 0;
  };
  [[nodiscard]] const Statistics& statistics() const;

  /// The finite element discretisation; for internal use in this module.
  [[nodiscard]] const detail::Discretisation& discretisation() const;

 private:
  struct Parts;
  explicit Tissue(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// Stiffness block of element t between its local nodes a and b: V [λ g_a g_bᵀ + μ g_b g_aᵀ + μ (g_a·g_b) I] [N/mm]
/// (3×3).
/// @param volume [mm³]
/// @param gradients barycentric gradients [1/mm] (3×4)
Mat3 element_block(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material, int a, int b);

}  // namespace stylet
