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

/// Linear elastic, quasi-static tissue on tetrahedra, held at the nodes of its fundamental displacement
/// constraints: K u = f with K symmetric positive definite on the free degrees of freedom, factorised once.
/// Immutable after build; safe to share between threads for reading (each caller brings its own Workspace).
class Tissue {
 public:
  /// @param mesh checked mesh (kept by value)
  /// @param materials one per region of the mesh
  /// @param fixed node numbers held at zero displacement; enough to exclude rigid motion, else an error says so. A
  ///   node that the kind of element adds between two of them is held as well.
  /// @param corridor nodes of the mesh whose compliance will be asked for, see compliance_of_corridor()
  static Result<Tissue> build(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                              const Progress& progress = {}, Element element = Element::p1,
                              const std::vector<Index>& corridor = {});

  /// The same without its factor, for a tissue whose compliance is known already: what needs the factor makes it when
  /// first called, once, whichever thread comes first. Memory that runs out then is a std::bad_alloc.
  static Result<Tissue> build_later(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                                    Element element, const std::vector<Index>& corridor);

  Tissue(Tissue&&) noexcept;
  Tissue& operator=(Tissue&&) noexcept;
  ~Tissue();

  [[nodiscard]] const TetMesh& mesh() const;
  [[nodiscard]] Element element() const;

  /// Nodes that carry displacements: the mesh's, under the mesh's numbers, and after them any that the kind of element
  /// adds. Wherever this class speaks of nodes it means these, n in number.
  [[nodiscard]] Index displacement_nodes() const;
  [[nodiscard]] Vec3 node_position(Index node) const;  ///< [mm] LPS, undeformed
  /// Nodes of the mesh halfway between which a node lies; a node of the mesh lies at itself.
  [[nodiscard]] std::array<Index, 2> ends_of(Index node) const;
  [[nodiscard]] std::span<const Index> nodes_of(Index tet) const;  ///< displacement nodes of an element

  /// Interpolation at a material point: a base tetrahedron and the barycentric weights in it.
  [[nodiscard]] Shape shape(Index tet, const Vec4& weights) const;
  [[nodiscard]] ShapeGradients shape_gradients(Index tet, const Vec4& weights) const;

  [[nodiscard]] const Material& material(int region) const;
  [[nodiscard]] const std::vector<Material>& materials() const;
  [[nodiscard]] bool is_fixed(Index node) const;
  [[nodiscard]] const std::vector<Index>& fixed_nodes() const;  ///< sorted

  /// Free degrees of freedom: 3 × (displacement nodes − fixed ones). Node a's first one, or -1 where it is fixed.
  [[nodiscard]] Index free_dofs() const;
  [[nodiscard]] Index first_dof(Index node) const;

  /// Stiffness on the free degrees of freedom, both triangles stored [N/mm] (free × free).
  [[nodiscard]] const Eigen::SparseMatrix<double>& stiffness() const;

  /// u = K⁻¹ f for one or many right-hand sides. Allocates; never called by a step.
  /// @param f [N] (3n × k) over all nodes, rows of fixed nodes are ignored
  /// @return [mm] (3n × k), zero at fixed nodes
  [[nodiscard]] MatX solve(const MatX& f) const;

  /// The corridor's nodes that can move, in the order given, and those that the kind of element adds between two of
  /// them. Nodes that are read together had better be neighbours in it.
  [[nodiscard]] const std::vector<Index>& corridor() const;

  /// K⁻¹ between the nodes of corridor(), in their order [mm/N] (3c × 3c), symmetric to the last bit. They are
  /// eliminated last, so this is the inverse of a dense block of the factor, without a solve for each of them
  /// (docs/theory/tissue.md, Compliance). Allocates and takes O(c³); ask once.
  [[nodiscard]] MatX compliance_of_corridor(const Progress& progress = {}) const;

  /// Whether the factor is there.
  [[nodiscard]] bool has_factor() const;

  /// Forces the supports exert on the tissue [N] (3n), non-zero at fixed nodes only: K_full u on their rows.
  [[nodiscard]] VecX support_forces(const VecX& u) const;

  /// Cauchy stress in the middle of every element (constant in linear ones): xx yy zz xy yz zx [MPa] (6 × tets).
  /// @param u [mm] (3 × displacement nodes), or of the mesh's nodes only (3 × mesh nodes): what quadratic elements add
  ///   is then not known, and the stress is that of linear ones with averaged pressure
  [[nodiscard]] MatX stress(const VecX& u) const;

  /// Numbers for reports.
  struct Statistics {
    double factor_seconds = 0;
    double factor_mb = 0;
    Index factor_entries = 0;
  };
  [[nodiscard]] const Statistics& statistics() const;

  /// How the stiffness is made of elements; for the parts of this module.
  [[nodiscard]] const detail::Discretisation& discretisation() const;

 private:
  struct Parts;
  explicit Tissue(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// Stiffness block of element t between local nodes a and b: V [λ g_a g_bᵀ + μ g_b g_aᵀ + μ (g_a·g_b) I] [N/mm] (3×3).
/// @param gradients barycentric gradients [1/mm] (3×4)
Mat3 element_block(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material, int a, int b);

}  // namespace stylet
