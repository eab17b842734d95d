// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/interface_distance.hpp"
#include "stylet/coupling/near_field/kelvinlet.hpp"
#include "stylet/coupling/near_field/surface_distance.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/topology.hpp"

#include <functional>
#include <memory>
#include <span>
#include <utility>

namespace stylet {

/// What a mesh makes of a point force nearby: the discrete counterpart of the medium's kernel, between displacement
/// nodes.
///
/// For a node q the problem is solved on a patch, three rings of elements around it, made of one medium throughout,
/// with the kernel itself prescribed on the patch's rim and a unit force on q. Held nodes follow the kernel as the rim
/// does, outer faces are free, and the kernel has their image. What comes out, g(p,q), has the singular part of the
/// tissue's K⁻¹ and its discretisation error, and nothing else; K⁻¹ − g is smooth. docs/theory/near_field.md §3.
///
/// Each of two nodes' patches has its own answer for the pair; g is the mean of the two, which obeys action and
/// reaction.
///
/// Computed before the needle comes; reading neither solves nor allocates. A row is never changed, so a copy of a
/// kernel shares its rows and grows on its own.
class MeshKernel {
 public:
  /// What the patch of one node makes of a unit force on it.
  struct Row {
    Index node = -1;
    double edge = 0.0;
    NearSurface skin;
    std::vector<std::pair<int, NearInterfaces>> interfaces;  ///< by the regions that have the node
    std::vector<Index> near;                                 ///< nodes of the patch that are not on its rim, ascending
    std::vector<std::vector<Mat3>> blocks;  ///< (media)(near) [mm/N] for E = 1 MPa; none of a medium not in the patch
  };

  /// @param tissue its mesh
  /// @param topology of that mesh; not kept
  MeshKernel(std::shared_ptr<const Tissue> tissue, const Topology& topology);

  /// Makes g among these nodes and those there already available. Not for the step.
  void add_nodes(std::span<const Index> nodes, const Progress& progress = {});

  /// All that was solved for, in the order in which nodes were added (for one call of add_nodes(): ascending).
  [[nodiscard]] std::vector<double> numbers() const;

  /// The same with what numbers() gave for these nodes in this tissue, instead of solving.
  /// @return false, with nothing changed, when there are not as many numbers as these nodes have
  [[nodiscard]] bool add_nodes(std::span<const Index> nodes, std::span<const double> numbers);

  /// Solves for one more node. const: any thread may.
  [[nodiscard]] std::shared_ptr<const Row> make_row(Index node) const;
  /// Takes over a row, or with a null pointer gives one up. Wait-free; neither allocates nor frees.
  /// @param row gets what the node had before, to be freed elsewhere
  void exchange(Index node, std::shared_ptr<const Row>& row) { rows_[static_cast<std::size_t>(node)].swap(row); }

  [[nodiscard]] bool has(Index node) const { return rows_[static_cast<std::size_t>(node)] != nullptr; }

  /// g(p,q) for E = 1 MPa [mm/N]: displacement of p per force on q. Both must be there.
  /// @param medium number of the medium, medium_of() of an element that has p or q
  [[nodiscard]] Mat3 operator()(Index p, Index q, int medium) const;

  /// Whether two nodes are so near each other through the material that one's patch has the other inside.
  [[nodiscard]] bool neighbours(Index p, Index q) const { return place_of(p, row(q)) >= 0; }

  /// Media differ by their Poisson ratio; E only scales.
  [[nodiscard]] int medium_of(int region) const { return ground_->region_medium[static_cast<std::size_t>(region)]; }
  [[nodiscard]] Medium medium(int number) const;  ///< with E = 1 MPa
  [[nodiscard]] int media() const { return static_cast<int>(ground_->poisson.size()); }

  /// The free surface near a node.
  [[nodiscard]] const NearSurface& skin(Index node) const { return row(node).skin; }

  /// The interfaces near a node of a region, to tissue of another modulus.
  [[nodiscard]] const NearInterfaces& interfaces_of(Index node, int region) const;

  /// Mean length of the edges at a node [mm].
  [[nodiscard]] double edge(Index node) const { return row(node).edge; }

  /// Radius over which the mesh smears a force on a node: the ε of the regularised kernel with the same
  /// self-compliance. Of nodes away from surfaces. For reports; no force depends on it.
  struct Blur {
    double smallest_mm = 0.0;
    double median_mm = 0.0;
    double largest_mm = 0.0;
    int nodes = 0;
  };
  [[nodiscard]] Blur blur() const;

 private:
  /// What rows are made of; shared by copies.
  struct Ground {
    SurfaceDistance skin;
    InterfaceDistance interfaces;
    std::vector<double> poisson;                ///< (media)
    std::vector<int> region_medium;             ///< (regions)
    std::vector<std::vector<Index>> node_tets;  ///< (n) elements around a displacement node
  };
  /// The elements of a patch and their nodes.
  struct Rings {
    std::vector<Index> tets;   ///< ascending
    std::vector<Index> nodes;  ///< of the elements, ascending
    std::vector<char> moves;   ///< (nodes) neither held nor on the rim
  };
  using SkinAt = std::function<NearSurface(Index node)>;
  [[nodiscard]] std::vector<Index> missing(std::span<const Index> nodes) const;
  [[nodiscard]] Rings rings_around(Index node) const;
  [[nodiscard]] Row unsolved_row(Index node, const Rings& rings) const;
  void solve(Row& row, const Rings& rings, const SkinAt& skin_at) const;
  [[nodiscard]] NearSurface nearest_skin(Index node) const {
    return ground_->skin.nearest(tissue_->node_position(node));
  }
  [[nodiscard]] const Row& row(Index node) const { return *rows_[static_cast<std::size_t>(node)]; }
  /// Number of a node among those near a row's node, or −1.
  [[nodiscard]] static std::ptrdiff_t place_of(Index node, const Row& row);
  [[nodiscard]] static const Mat3* find(const Row& row, Index node, int medium);

  std::shared_ptr<const Tissue> tissue_;
  std::shared_ptr<const Ground> ground_;
  std::vector<std::shared_ptr<const Row>> rows_;  ///< (n) null where there is none
  std::vector<Index> added_;                      ///< by add_nodes(), in this order
};

}  // namespace stylet
