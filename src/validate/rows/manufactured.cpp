// SPDX-License-Identifier: GPL-3.0-or-later
// Convergence of the tissue with the mesh, on a manufactured solution.
#include "../rows.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace stylet::validate {

namespace {

constexpr double kSide_mm = 60.0;
const Material kMaterial{0.02, 0.3};
const Vec3 kAmplitude(1.0, -0.7, 0.4);

/// u = d sin(πx/L) sin(πy/L) sin(πz/L), zero on the surface of the cube.
Vec3 exact(const Vec3& x) {
  const Vec3 s = (std::numbers::pi / kSide_mm * x).array().sin();
  return s.prod() * kAmplitude;
}

/// The body force that holds it [N/mm³]: −div σ = −(λ+μ) H d − μ tr(H) d with H the Hessian of the product.
Vec3 body_force(const Vec3& x) {
  const double k = std::numbers::pi / kSide_mm;
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

/// Weights of four points inside a tetrahedron that integrate quadratic functions exactly, each with a quarter of its
/// volume.
std::array<Vec4, 4> points() {
  const double far = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0;
  const double near = (5.0 - std::sqrt(5.0)) / 20.0;
  std::array<Vec4, 4> rule;
  for (int i = 0; i < 4; ++i) rule[static_cast<std::size_t>(i)] = Vec4::Constant(near) + (far - near) * Vec4::Unit(i);
  return rule;
}

/// ‖u_h − u‖ / ‖u‖ in L2.
Result<double> error_of(int cells) {
  TetMesh mesh = box_mesh({0, 0, 0}, Vec3::Constant(kSide_mm), {cells, cells, cells}, 0.1);
  std::vector<Index> surface;
  for (Index a = 0; a < mesh.node_count(); ++a) {
    const auto x = mesh.nodes[static_cast<std::size_t>(a)].array();
    if ((x == 0.0).any() || (x == kSide_mm).any()) surface.push_back(a);
  }
  const auto tissue = Tissue::build(std::move(mesh), {kMaterial}, surface);
  if (!tissue) return tissue.error();
  const TetMesh& m = tissue->mesh();
  const auto rule = points();
  const auto each = [&](auto&& visit) {
    for (Index t = 0; t < m.tet_count(); ++t) {
      const auto& tet = m.tets[static_cast<std::size_t>(t)];
      for (const Vec4& w : rule) {
        Vec3 x = Vec3::Zero();
        for (int a = 0; a < 4; ++a) x += w[a] * m.nodes[static_cast<std::size_t>(tet[static_cast<std::size_t>(a)])];
        visit(tet, w, x, 0.25 * tet_volume(m, t));
      }
    }
  };
  VecX f = VecX::Zero(3 * Eigen::Index{m.node_count()});
  each([&](const auto& tet, const Vec4& w, const Vec3& x, double volume) {
    const Vec3 force = volume * body_force(x);
    for (int a = 0; a < 4; ++a) f.segment<3>(3 * tet[static_cast<std::size_t>(a)]) += w[a] * force;
  });
  const VecX u = tissue->solve(f);
  double error = 0.0;
  double norm = 0.0;
  each([&](const auto& tet, const Vec4& w, const Vec3& x, double volume) {
    Vec3 found = Vec3::Zero();
    for (int a = 0; a < 4; ++a) found += w[a] * u.segment<3>(3 * tet[static_cast<std::size_t>(a)]);
    error += volume * (found - exact(x)).squaredNorm();
    norm += volume * exact(x).squaredNorm();
  });
  return std::sqrt(error / norm);
}

Result<Finding> order(Context&) {
  Curve ours{.label = "linear tetrahedra", .x = {}, .y = {}};
  Curve slope{.label = "order 2", .x = {}, .y = {}, .kind = Curve::Kind::reference};
  for (const int cells : {20, 14, 10, 7, 5}) {
    const auto error = error_of(cells);
    if (!error) return error.error();
    const double h = kSide_mm / cells;
    ours.x.push_back(h);
    ours.y.push_back(*error);
    slope.x.push_back(h);
    slope.y.push_back(ours.y.front() * std::pow(h / ours.x.front(), 2) / 1.3);
  }
  Finding finding;
  finding.value = std::log(ours.y[2] / ours.y[0]) / std::log(ours.x[2] / ours.x[0]);
  finding.note = "Irregular meshes of 5³ … 20³ cells, six tetrahedra each; order between 10³ and 20³.";
  finding.plot = {.x_label = "cell size [mm]",
                  .y_label = "relative error in L2",
                  .log_x = true,
                  .log_y = true,
                  .curves = {ours, slope}};
  return finding;
}

}  // namespace

std::vector<RowSpec> manufactured_rows() {
  return {{"manufactured_order", Group::analysis, "Linear tetrahedra converge with order 2",
           "manufactured solution, error in L2", "", Accepted::between(1.9, 2.1), true, order}};
}

}  // namespace stylet::validate
