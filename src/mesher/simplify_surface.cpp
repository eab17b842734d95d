// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify_surface.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <cstddef>

namespace stylet::meshing {
namespace {

namespace simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// [mm⁶] Largest cost of an edge that is collapsed, which is the squared volume between the surfaces before and after.
/// Raised, surfaces get fewer triangles and become less round.
constexpr double kMostCost = 0.001;

/// The cost of collapsing an edge; none for one that is too long.
struct CostOfShortEdges {
  simplification::LindstromTurk_cost<Mesh> cost;
  double longest_mm;

  template <class Profile>
  boost::optional<double> operator()(const Profile& profile, const boost::optional<Kernel::Point_3>& place) const {
    if (CGAL::squared_distance(profile.p0(), profile.p1()) > longest_mm * longest_mm) return boost::none;
    return cost(profile, place);
  }
};

struct EndsAtMostCost {
  template <class Profile>
  bool operator()(double cost, const Profile&, std::size_t, std::size_t) const {
    return cost > kMostCost;
  }
};

}  // namespace

void simplify(Surface& surface, double longest_mm) {
  Mesh mesh;
  for (const Vec3& x : surface.points) mesh.add_vertex({x.x(), x.y(), x.z()});
  for (const auto& t : surface.triangles)
    mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
  using Placement = simplification::Bounded_normal_change_placement<simplification::LindstromTurk_placement<Mesh>>;
  simplification::edge_collapse(
      mesh, EndsAtMostCost{},
      CGAL::parameters::get_cost(CostOfShortEdges{.cost = {}, .longest_mm = longest_mm}).get_placement(Placement()));
  mesh.collect_garbage();
  surface.points.clear();
  surface.triangles.clear();
  for (const Mesh::Vertex_index n : mesh.vertices()) {
    // Files have coordinates of single precision.
    const auto single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
    const Kernel::Point_3& x = mesh.point(n);
    surface.points.emplace_back(single(x.x()), single(x.y()), single(x.z()));
  }
  for (const Mesh::Face_index face : mesh.faces()) {
    std::array<Index, 3> corners{};
    std::size_t k = 0;
    for (const Mesh::Vertex_index n : vertices_around_face(mesh.halfedge(face), mesh))
      corners[k++] = static_cast<Index>(n.idx());
    surface.triangles.push_back(corners);
  }
}

}  // namespace stylet::meshing
