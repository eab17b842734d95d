// SPDX-License-Identifier: GPL-3.0-or-later
// Convergence of the tissue with mesh refinement, for a manufactured solution.
#include "../quadrature.hpp"
#include "../rows.hpp"
#include "../solids.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace stylet::validate {

namespace {

constexpr double kCube_mm = 60.0;
const Material kMaterial{0.02, 0.3};
const Vec3 kAmplitude(1.0, -0.7, 0.4);

/// u = d sin(πx/L) sin(πy/L) sin(πz/L), zero on the surface of the cube.
Vec3 exact(const Vec3& x) {
  const Vec3 s = (std::numbers::pi / kCube_mm * x).array().sin();
  return s.prod() * kAmplitude;
}

/// The body force of this displacement [N/mm³]: −div σ = −(λ+μ) H d − μ tr(H) d, where H is the Hessian of the product
/// of sines.
Vec3 body_force(const Vec3& x) {
  const double k = std::numbers::pi / kCube_mm;
  const Vec3 s = (k * x).array().sin();
  const Vec3 c = (k * x).array().cos();
  Mat3 H = Mat3::Identity() * -s.prod();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    H(i, j) = H(j, i) = c[i] * c[j] * s[(i + 2) % 3];
  }
  H *= k * k;
  return -(kMaterial.lambda() + kMaterial.mu()) * H * kAmplitude - kMaterial.mu() * H.trace() * kAmplitude;
}

/// ‖u_h − u‖ / ‖u‖ in L2.
double error_of(int cells, Element element) {
  TetMesh mesh = box_mesh({0, 0, 0}, Vec3::Constant(kCube_mm), {cells, cells, cells}, 0.1);
  const auto surface =
      nodes_where(mesh, [](const Vec3& x) { return (x.array() == 0.0).any() || (x.array() == kCube_mm).any(); });
  const auto tissue = need(Tissue::build(std::move(mesh), {kMaterial}, surface, {}, element));
  const TetMesh& m = tissue.mesh();
  const auto rule = tetrahedron_rule(4);
  const auto each = [&](auto&& visit) {
    for (Index t = 0; t < m.tet_count(); ++t) {
      const double volume = tet_volume(m, t);
      for (const TetrahedronPoint& point : rule) {
        Vec3 x = Vec3::Zero();
        for (int a = 0; a < 4; ++a) {
          const Index node = m.tets[static_cast<std::size_t>(t)][static_cast<std::size_t>(a)];
          x += point.weights[a] * m.nodes[static_cast<std::size_t>(node)];
        }
        visit(tissue.shape(t, point.weights), x, volume * point.factor);
      }
    }
  };
  VecX f = VecX::Zero(3 * Eigen::Index{tissue.displacement_nodes()});
  each([&](const Shape& shape, const Vec3& x, double volume) {
    const Vec3 force = volume * body_force(x);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      f.segment<3>(3 * Eigen::Index{shape.node[i]}) += shape.weight[i] * force;
  });
  const VecX u = tissue.solve(f);
  double error = 0.0;
  double norm = 0.0;
  each([&](const Shape& shape, const Vec3& x, double volume) {
    Vec3 found = Vec3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      found += shape.weight[i] * u.segment<3>(3 * Eigen::Index{shape.node[i]});
    error += volume * (found - exact(x)).squaredNorm();
    norm += volume * exact(x).squaredNorm();
  });
  return std::sqrt(error / norm);
}

/// Measures the order of convergence. @param cells ascending; the last must be twice the third-last
Finding order(Element element, const std::string& label, int expected, const std::vector<int>& cells) {
  Curve ours{.label = label};
  Curve slope{.label = fmt::format("order {}", expected), .kind = Curve::Kind::reference};
  for (auto n = cells.rbegin(); n != cells.rend(); ++n) {
    const auto error = error_of(*n, element);
    const double h = kCube_mm / *n;
    ours.add(h, error);
    slope.add(h, ours.y.front() * std::pow(h / ours.x.front(), expected) / 1.3);
  }
  Finding finding;
  finding.value = std::log(ours.y[2] / ours.y[0]) / std::log(ours.x[2] / ours.x[0]);
  finding.note = fmt::format(
      "Irregular meshes of {0}³ … {1}³ cells with six tetrahedra each. The value is the order between {2}³ and {1}³.",
      cells.front(), cells.back(), cells[cells.size() - 3]);
  finding.why_missed = "The order is reached on sufficiently fine meshes; these meshes are coarser.";
  finding.plot = {.x_label = "cell size [mm]",
                  .y_label = "relative error in L2",
                  .log_x = true,
                  .log_y = true,
                  .curves = {ours, slope}};
  return finding;
}

}  // namespace

std::vector<RowSpec> manufactured_rows() {
  const std::string reference = "manufactured solution, error in L2";
  return {{"manufactured_order", Group::analysis, "Linear tetrahedra converge with order 2", reference, "",
           Accepted::between(1.9, 2.1), true,
           [](Context&) {
             return order(Element::p1, "linear tetrahedra", 2, {5, 7, 10, 14, 20});
           }},
          {"manufactured_order_p2", Group::analysis, "Quadratic tetrahedra converge with order 3", reference, "",
           Accepted::between(2.9, 3.1), true, [](Context&) {
             return order(Element::p2, "quadratic tetrahedra", 3, {3, 4, 6, 8, 12});
           }}};
}

}  // namespace stylet::validate
