// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace stylet::meshing {

/// A point on the surface between two regions, from which meshing of the surface starts.
struct SurfaceSeed {
  Vec3 position = Vec3::Zero();
  std::array<int, 2> labels{0, 0};  ///< ascending
};

/// Input of the mesh generator.
struct TetrahedraliserInput {
  std::function<int(const Vec3&)> label;    ///< region number of a point, 0 = outside
  std::function<double(const Vec3&)> size;  ///< wanted edge length at a point [mm]
  Eigen::AlignedBox3d box;                  ///< [mm] LPS, contains everything
  std::vector<SurfaceSeed> seeds;
  double facet_angle_deg = 25;
  double facet_distance = 0.12;  ///< largest distance between a face and its surface / wanted edge length
  double radius_edge_ratio = 2.0;
  std::size_t most_nodes = 1000000;  ///< refinement fails beyond this number
};

/// Tetrahedra of the mesh generator, before they become a TetMesh.
struct RawMesh {
  std::vector<Vec3> nodes;
  std::vector<std::array<Index, 4>> tets;  ///< positive volume
  std::vector<int> label;                  ///< (tetrahedra) region number
};

/// Delaunay refinement and optimisation (CGAL Mesh_3). Deterministic; uses one thread.
class Tetrahedraliser {
 public:
  explicit Tetrahedraliser(TetrahedraliserInput input);
  ~Tetrahedraliser();

  /// Refines until all criteria are met. Errors: more than `most_nodes` nodes.
  Result<> refine();
  /// Moves nodes to the centroids of their Voronoi cells (Lloyd's method); surface nodes stay on their surface.
  void relax(int rounds);
  /// The current mesh.
  [[nodiscard]] RawMesh mesh() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::meshing
