// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/box_mesh.hpp"
#include "stylet/probe/probe_contact.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <vector>

namespace stylet::testing {

/// A block whose upper face, z = 0, is a wall: the lumen is above it. Its lower face is fixed.
struct Block {
  std::shared_ptr<const Tissue> tissue;
  std::vector<WallFace> faces;

  explicit Block(TetMesh mesh, Material material, const std::function<bool(const Vec3&)>& is_wall,
                 const std::function<bool(const Vec3&)>& is_fixed, Element element = Element::p1) {
    const Topology topology(mesh);
    for (const Face& face : topology.boundary) {
      Vec3 middle = Vec3::Zero();
      for (const Index node : face.nodes) middle += mesh.nodes[static_cast<std::size_t>(node)] / 3.0;
      if (!is_wall(middle)) continue;
      const Vec3& a = mesh.nodes[static_cast<std::size_t>(face.nodes[0])];
      const Vec3& b = mesh.nodes[static_cast<std::size_t>(face.nodes[1])];
      const Vec3& c = mesh.nodes[static_cast<std::size_t>(face.nodes[2])];
      faces.push_back({face.nodes, face.tet, -(b - a).cross(c - a).normalized()});
    }
    std::vector<Index> fixed;
    for (Index n = 0; n < mesh.node_count(); ++n)
      if (is_fixed(mesh.nodes[static_cast<std::size_t>(n)])) fixed.push_back(n);
    tissue = std::make_shared<const Tissue>(Tissue::build(std::move(mesh), {material}, fixed, {}, element).value());
  }

  [[nodiscard]] std::shared_ptr<const WallCompliance> wall(const WallReach& reach) const {
    return std::make_shared<const WallCompliance>(
        WallCompliance::solve(*tissue, wall_points(*tissue, faces, reach)).value());
  }
};

inline bool is_top(const Vec3& x) { return x.z() > -1e-6; }

/// A block 40 × 40 × 20 mm of 10 kPa.
inline Block soft_block(int cells = 10, double jitter = 0.1, Element element = Element::p1) {
  return Block(
      box_mesh({-20, -20, -20}, {20, 20, 0}, {cells, cells, cells / 2}, jitter), {0.01, 0.3}, is_top,
      [](const Vec3& x) { return x.z() < -19.999; }, element);
}

/// A probe whose rounded end presses down on the block's middle by a depth.
inline Capsule pressing_down(double depth_mm, double radius_mm = 10.0) {
  return {{0.7, -0.4, radius_mm - depth_mm}, -Vec3::UnitZ(), radius_mm};
}

/// A probe that lies on the block along x, its rounded end in the middle, and presses by a depth.
inline Capsule lying_on(double depth_mm, double radius_mm = 8.0) {
  return {{2.0, 0.3, radius_mm - depth_mm}, Vec3::UnitX(), radius_mm};
}

inline WallReach reach_of(const Capsule& probe, double spacing_mm, int points = 150) {
  WallReach reach;
  reach.rest = probe;
  reach.finest = -Vec3::UnitZ();
  reach.spacing_mm = spacing_mm;
  reach.points = points;
  reach.beyond_mm = 100.0;
  reach.fine_mm = 1e6;
  return reach;
}

}  // namespace stylet::testing
