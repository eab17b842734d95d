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

class Patch;

/// The mesh kernel g: the displacement that this mesh gives to a point force in an unbounded medium, near the force. It
/// is the discrete counterpart of the medium's kernel, between displacement nodes.
///
/// For a node q the elastic problem is solved on a patch: three rings of elements around q, taken as one medium, with
/// the medium's kernel prescribed on the patch's rim and a unit force on q. Held nodes follow the kernel as the rim
/// does; outer faces are free, and the kernel then includes their image. The solution g(p,q) contains the singular part
/// of the tissue's K⁻¹ together with its discretisation error, and nothing else, so K⁻¹ − g is smooth.
/// docs/theory/near_field.md §3.
///
/// The patches of two nodes give two values for the pair; g is their mean, so action equals reaction.
///
/// Rows are computed before the needle arrives; reading them neither solves nor allocates. A row never changes, so
/// copies of a kernel share their rows, and each copy can add rows of its own.
class MeshKernel {
 public:
  /// The solution on the patch of one node.
  struct Row {
    Index node = -1;
    double edge = 0.0;                                       ///< [mm] mean length of the edges at the node
    NearSurface skin;                                        ///< the free surface nearest to the node
    std::vector<std::pair<int, NearInterfaces>> interfaces;  ///< for each region that has the node
    std::vector<Index> near;                                 ///< nodes of the patch that are not on its rim, ascending
    /// (media)(near) [mm/N] displacements for E = 1 MPa; empty for a medium that the patch does not contain.
    std::vector<std::vector<Mat3>> blocks;
  };

  /// @param topology of the tissue's mesh; not kept
  MeshKernel(std::shared_ptr<const Tissue> tissue, const Topology& topology);

  /// Makes g available among these nodes and those added before. Solves and allocates; not for the step.
  void add_nodes(std::span<const Index> nodes, const Progress& progress = {});

  /// The values of all rows, in the order in which nodes were added (in one call of add_nodes(): ascending).
  [[nodiscard]] std::vector<double> numbers() const;

  /// Adds nodes with the values that numbers() gave for these nodes in this tissue, instead of solving.
  /// @return false, with nothing changed, when the count of values does not fit these nodes
  [[nodiscard]] bool add_nodes(std::span<const Index> nodes, std::span<const double> numbers);

  /// Solves for one more node without adding it; any thread may call this.
  [[nodiscard]] std::shared_ptr<const Row> make_row(Index node) const;
  /// Puts a row in the place of the node's present row; a null pointer gives the row up. Wait-free; neither allocates
  /// nor frees.
  /// @param row receives the node's previous row, to be freed elsewhere
  void exchange(Index node, std::shared_ptr<const Row>& row) { rows_[static_cast<std::size_t>(node)].swap(row); }

  [[nodiscard]] bool has(Index node) const { return rows_[static_cast<std::size_t>(node)] != nullptr; }

  /// g(p,q) for E = 1 MPa [mm/N]: displacement of p per force on q. Both nodes must be available.
  /// @param medium medium_of() the region of an element that has p or q
  [[nodiscard]] Mat3 operator()(Index p, Index q, int medium) const;

  /// Whether p lies inside the patch of q, away from its rim.
  [[nodiscard]] bool neighbours(Index p, Index q) const { return place_of(p, row(q)) >= 0; }

  /// Number of the medium of a region. Media differ by their Poisson ratio only, because E scales the result.
  [[nodiscard]] int medium_of(int region) const { return ground_->region_medium[static_cast<std::size_t>(region)]; }
  [[nodiscard]] Medium medium(int number) const;  ///< with E = 1 MPa
  [[nodiscard]] int media() const { return static_cast<int>(ground_->poisson.size()); }

  /// The free surface that is nearest to a node.
  [[nodiscard]] const NearSurface& skin(Index node) const { return row(node).skin; }

  /// The interfaces between `region` and tissue of another modulus that are nearest to a node of the region.
  [[nodiscard]] const NearInterfaces& interfaces_of(Index node, int region) const;

  /// Mean length of the edges at a node [mm].
  [[nodiscard]] double edge(Index node) const { return row(node).edge; }

  /// Blur: the radius over which the mesh smears a force on a node, that is the ε of the Kelvinlet with the same
  /// self-compliance. Counts nodes away from surfaces only. For reports; no force depends on it.
  struct Blur {
    double smallest_mm = 0.0;
    double median_mm = 0.0;
    double largest_mm = 0.0;
    int nodes = 0;
  };
  [[nodiscard]] Blur blur() const;

 private:
  /// Data that rows are computed from; copies share it.
  struct Ground {
    SurfaceDistance skin;
    InterfaceDistance interfaces;
    std::vector<double> poisson;                ///< (media)
    std::vector<int> region_medium;             ///< (regions)
    std::vector<std::vector<Index>> node_tets;  ///< (n) elements that have a displacement node
  };
  /// The elements of a patch, and their nodes.
  struct Rings {
    std::vector<Index> tets;   ///< ascending
    std::vector<Index> nodes;  ///< nodes of these elements, ascending
    std::vector<char> moves;   ///< (nodes) whether a node is neither held nor on the rim
  };
  using SkinAt = std::function<NearSurface(Index node)>;
  [[nodiscard]] std::vector<Index> missing(std::span<const Index> nodes) const;
  [[nodiscard]] Rings rings_around(Index node) const;
  [[nodiscard]] Row unsolved_row(Index node, const Rings& rings) const;
  void solve(Row& row, const Rings& rings, const SkinAt& skin_at, Patch& patch) const;
  [[nodiscard]] NearSurface nearest_skin(Index node) const {
    return ground_->skin.nearest(tissue_->node_position(node));
  }
  [[nodiscard]] const Row& row(Index node) const { return *rows_[static_cast<std::size_t>(node)]; }
  /// Number of a node among Row::near, or −1.
  [[nodiscard]] static std::ptrdiff_t place_of(Index node, const Row& row);
  [[nodiscard]] static const Mat3* find(const Row& row, Index node, int medium);

  std::shared_ptr<const Tissue> tissue_;
  std::shared_ptr<const Ground> ground_;
  std::vector<std::shared_ptr<const Row>> rows_;  ///< (n) null where the node has no row
  std::vector<Index> added_;                      ///< nodes in the order in which add_nodes() added them
};

}  // namespace stylet
