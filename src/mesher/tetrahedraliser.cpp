// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that includes CGAL's mesh generator, because that takes long to compile.
#define CGAL_NO_WARNINGS  // warnings go to the terminal; what matters comes back as an error code

#include "tetrahedraliser.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/lloyd_optimize_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include <fmt/format.h>
#include <map>

namespace stylet::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Tr = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using C3t3 = CGAL::Mesh_complex_3_in_triangulation_3<Tr>;
using Criteria = CGAL::Mesh_criteria_3<Tr>;
using Point = Kernel::Point_3;
namespace params = CGAL::parameters;

// Limits of the radius of a face's surface ball and of a tetrahedron's sphere / wanted edge length. With these values
// the mean edge is about as long as wanted.
constexpr double kFaceRadius = 0.72;
constexpr double kCellRadius = 0.78;
constexpr double kSurfaceError = 2e-6;  // share of the box at which bisection ends

Vec3 vec(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Size criterion in CGAL's interface.
struct ScaledSize {
  using FT = Kernel::FT;
  const std::function<double(const Vec3&)>* size;
  double factor;
  template <class Index>
  FT operator()(const Point& p, int, const Index&) const {
    return factor * (*size)(vec(p));
  }
};

}  // namespace

struct Tetrahedraliser::Parts {
  TetrahedraliserInput input;
  CGAL::Random random{0};
  Domain domain;
  C3t3 c3t3;

  explicit Parts(TetrahedraliserInput in)
      : input(std::move(in)),
        domain([this](const Point& p) { return input.label(vec(p)); },
               CGAL::Bbox_3(input.box.min().x(), input.box.min().y(), input.box.min().z(), input.box.max().x(),
                            input.box.max().y(), input.box.max().z()),
               params::relative_error_bound = kSurfaceError, params::p_rng = &random) {}
};

Tetrahedraliser::Tetrahedraliser(TetrahedraliserInput input) : parts_(std::make_unique<Parts>(std::move(input))) {}
Tetrahedraliser::~Tetrahedraliser() = default;

Result<> Tetrahedraliser::refine() {
  Parts& p = *parts_;
  for (const SurfaceSeed& seed : p.input.seeds) {
    const Vec3& x = seed.position;
    const auto vertex = p.c3t3.triangulation().insert(Tr::Point(Point(x.x(), x.y(), x.z())));
    p.c3t3.set_dimension(vertex, 2);
    p.c3t3.set_index(vertex, p.domain.index_from_surface_patch_index({seed.labels[0], seed.labels[1]}));
  }
  const Criteria criteria(params::facet_angle = p.input.facet_angle_deg,
                          params::facet_size = ScaledSize{&p.input.size, kFaceRadius},
                          params::facet_distance = ScaledSize{&p.input.size, p.input.facet_distance},
                          params::cell_radius_edge_ratio = p.input.radius_edge_ratio,
                          params::cell_size = ScaledSize{&p.input.size, kCellRadius});
  CGAL::Mesh_error_code code = CGAL::CGAL_MESH_3_NO_ERROR;
  CGAL::refine_mesh_3(p.c3t3, p.domain, criteria, params::no_exude(), params::no_perturb(), params::no_odt(),
                      params::no_lloyd(), params::no_reset_c3t3(),
                      params::mesh_3_options(params::pointer_to_error_code = &code,
                                             params::maximal_number_of_vertices = p.input.most_nodes));
  if (code != CGAL::CGAL_MESH_3_NO_ERROR) {
    return failure("mesher", fmt::format("refinement did not end with fewer than {} nodes", p.input.most_nodes),
                   "Correct contours that are degenerate or far smaller than the rest, or ask for fewer nodes");
  }
  return Ok{};
}

void Tetrahedraliser::relax(int rounds) {
  CGAL::lloyd_optimize_mesh_3(parts_->c3t3, parts_->domain, params::time_limit = 0,
                              params::max_iteration_number = static_cast<std::size_t>(rounds));
}

RawMesh Tetrahedraliser::mesh() const {
  RawMesh m;
  const C3t3& c3t3 = parts_->c3t3;
  std::map<C3t3::Vertex_handle, Index> number;
  for (auto v = c3t3.triangulation().finite_vertices_begin(); v != c3t3.triangulation().finite_vertices_end(); ++v) {
    number[v] = -1;
  }
  for (auto c = c3t3.cells_in_complex_begin(); c != c3t3.cells_in_complex_end(); ++c) {
    std::array<Index, 4> tet{};
    for (int i = 0; i < 4; ++i) {
      Index& n = number[c->vertex(i)];
      if (n < 0) {
        n = static_cast<Index>(m.nodes.size());
        m.nodes.push_back(vec(c->vertex(i)->point().point()));
      }
      tet[i] = n;
    }
    const Vec3& a = m.nodes[tet[0]];
    if ((m.nodes[tet[1]] - a).cross(m.nodes[tet[2]] - a).dot(m.nodes[tet[3]] - a) < 0) std::swap(tet[2], tet[3]);
    m.tets.push_back(tet);
    m.label.push_back(c3t3.subdomain_index(c));
  }
  return m;
}

}  // namespace stylet::meshing
