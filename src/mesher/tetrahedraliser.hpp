// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace stylet::meshing {

/// A point on a surface between two regions, from which the surface is meshed.
struct SurfaceSeed {
  Vec3 position = Vec3::Zero();
  std::array<int, 2> labels{0, 0};  ///< ascending
};

/// What to mesh.
struct TetrahedraliserInput {
  std::function<int(const Vec3&)> label;    ///< 0 outside, else region number
  std::function<double(const Vec3&)> size;  ///< wanted edge length [mm]
  Eigen::AlignedBox3d box;                  ///< [mm] holds everything
  std::vector<SurfaceSeed> seeds;
  double facet_angle_deg = 25;
  double facet_distance = 0.12;  ///< largest distance of a face from its surface, times the size there
  double radius_edge_ratio = 2.0;
  std::size_t most_nodes = 1000000;  ///< give up beyond
};

/// Tetrahedra as they come, before they are a TetMesh.
struct RawMesh {
  std::vector<Vec3> nodes;
  std::vector<std::array<Index, 4>> tets;  ///< positive volume
  std::vector<int> label;                  ///< per tetrahedron
};

/// Delaunay refinement and optimisation (CGAL Mesh_3). Deterministic, single-threaded.
class Tetrahedraliser {
 public:
  explicit Tetrahedraliser(TetrahedraliserInput input);
  ~Tetrahedraliser();

  /// Refines until all criteria hold. Errors: more than `most_nodes` nodes.
  Result<> refine();
  /// Moves nodes to the centroids of their Voronoi cells (Lloyd), surface nodes on their surface.
  void relax(int rounds);
  /// The mesh as it is.
  [[nodiscard]] RawMesh mesh() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::meshing
