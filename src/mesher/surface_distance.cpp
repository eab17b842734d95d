// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_distance.hpp"

#include "stylet/geom/topology.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>

namespace stylet::meshing {

DistanceSummary distance_to_boundary(const TetMesh& mesh, int region, const std::vector<Vec3>& points) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };

  const Topology topology(mesh);
  Triangles triangles;
  const auto add = [&](const Face& f) {
    const bool here = mesh.tet_region[f.tet] == region;
    const bool there = f.neighbour >= 0 && mesh.tet_region[f.neighbour] == region;
    if (here == there) return;
    triangles.emplace_back(point(mesh.nodes[f.nodes[0]]), point(mesh.nodes[f.nodes[1]]), point(mesh.nodes[f.nodes[2]]));
  };
  for (const Face& f : topology.boundary) add(f);
  for (const Face& f : topology.interfaces) add(f);
  DistanceSummary summary;
  if (triangles.empty() || points.empty()) return summary;
  Tree tree(triangles.begin(), triangles.end());
  tree.accelerate_distance_queries();
  for (const Vec3& p : points) {
    const double d = std::sqrt(tree.squared_distance(point(p)));
    summary.sum += d;
    summary.max = std::max(summary.max, d);
    ++summary.count;
  }
  return summary;
}

}  // namespace stylet::meshing
