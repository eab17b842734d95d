// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"
#include "quadrature.hpp"

#include <cstdio>
#include <numbers>

namespace stylet {
namespace {

constexpr double kSide_mm = 60.0;
constexpr double kPi = std::numbers::pi;

// A displacement field that vanishes on the surface of the cube, with the body force −div σ that holds it [N/mm³].
struct Manufactured {
  std::function<Vec3(const Vec3&)> displacement;
  std::function<Vec3(const Vec3&)> body_force;
};

// u = d sin(πx/L) sin(πy/L) sin(πz/L), −div σ = −(λ+μ) H d − μ tr(H) d with H the Hessian of the product.
Manufactured bubble(const Material& material) {
  const Vec3 d(1.0, -0.7, 0.4);
  const double k = kPi / kSide_mm;
  const auto phi = [k](const Vec3& x) { return std::sin(k * x.x()) * std::sin(k * x.y()) * std::sin(k * x.z()); };
  const auto hessian = [k](const Vec3& x) {
    const Vec3 s = (k * x).array().sin();
    const Vec3 c = (k * x).array().cos();
    const double diagonal = -k * k * s.prod();
    const double xy = k * k * c.x() * c.y() * s.z();
    const double yz = k * k * s.x() * c.y() * c.z();
    const double zx = k * k * c.x() * s.y() * c.z();
    Mat3 H;
    H << diagonal, xy, zx, xy, diagonal, yz, zx, yz, diagonal;
    return H;
  };
  return {[=](const Vec3& x) { return Vec3(phi(x) * d); },
          [=](const Vec3& x) {
            const Mat3 H = hessian(x);
            return Vec3(-(material.lambda() + material.mu()) * H * d - material.mu() * H.trace() * d);
          }};
}

// A flow without change of volume, u = curl of (0, 0, S(x) S(y) sin(πz/L)) with S = sin²(π·/L): its body force −μ Δu
// does not depend on the Poisson ratio except through μ, so any loss of displacement is locking.
Manufactured incompressible(const Material& material) {
  const double k = kPi / kSide_mm;
  const auto S = [k](double x) { return std::pow(std::sin(k * x), 2); };
  const auto S1 = [k](double x) { return k * std::sin(2 * k * x); };
  const auto S2 = [k](double x) { return 2 * k * k * std::cos(2 * k * x); };
  const auto S3 = [k](double x) { return -4 * k * k * k * std::sin(2 * k * x); };
  const double scale = kSide_mm / kPi;
  return {[=](const Vec3& x) {
            const double g = scale * std::sin(k * x.z());
            return Vec3(S(x.x()) * S1(x.y()) * g, -S1(x.x()) * S(x.y()) * g, 0.0);
          },
          [=](const Vec3& x) {
            const double g = scale * std::sin(k * x.z());
            const double ux = S2(x.x()) * S1(x.y()) + S(x.x()) * S3(x.y()) - k * k * S(x.x()) * S1(x.y());
            const double uy = S3(x.x()) * S(x.y()) + S1(x.x()) * S2(x.y()) - k * k * S1(x.x()) * S(x.y());
            return Vec3(-material.mu() * g * ux, material.mu() * g * uy, 0.0);
          }};
}

struct Errors {
  double l2;        // ‖u_h − u‖ / ‖u‖ in L2
  double softness;  // work of the load on u_h / its work on u: 1 without error, below 1 when too stiff
};

Errors solve(const Manufactured& problem, const Material& material, int cells) {
  TetMesh mesh = box_mesh({0, 0, 0}, Vec3::Constant(kSide_mm), {cells, cells, cells}, 0.1);
  const auto fixed =
      test::nodes_where(mesh, [](const Vec3& x) { return (x.array() == 0.0).any() || (x.array() == kSide_mm).any(); });
  const Tissue tissue = test::build(std::move(mesh), {material}, fixed);
  const auto rule = test::quadrature();
  const auto at = [&](const std::array<Index, 4>& tet, const Vec4& w) {
    Vec3 x = Vec3::Zero();
    for (int a = 0; a < 4; ++a) x += w[a] * tissue.mesh().nodes[tet[a]];
    return x;
  };

  VecX f = VecX::Zero(3 * Eigen::Index{tissue.mesh().node_count()});
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) {
    const auto& tet = tissue.mesh().tets[t];
    for (const auto& point : rule) {
      const Vec3 force = tet_volume(tissue.mesh(), t) * point.factor * problem.body_force(at(tet, point.weights));
      for (int a = 0; a < 4; ++a) f.segment<3>(3 * Eigen::Index{tet[a]}) += point.weights[a] * force;
    }
  }
  const VecX u = tissue.solve(f);

  double error = 0.0;
  double norm = 0.0;
  double work_h = 0.0;
  double work = 0.0;
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) {
    const auto& tet = tissue.mesh().tets[t];
    const double volume = tet_volume(tissue.mesh(), t);
    for (const auto& point : rule) {
      const Vec3 x = at(tet, point.weights);
      Vec3 u_h = Vec3::Zero();
      for (int a = 0; a < 4; ++a) u_h += point.weights[a] * u.segment<3>(3 * Eigen::Index{tet[a]});
      const Vec3 exact = problem.displacement(x);
      error += volume * point.factor * (u_h - exact).squaredNorm();
      norm += volume * point.factor * exact.squaredNorm();
      work_h += volume * point.factor * u_h.dot(problem.body_force(x));
      work += volume * point.factor * exact.dot(problem.body_force(x));
    }
  }
  return {std::sqrt(error / norm), work_h / work};
}

TEST(TissueConvergence, LinearTetrahedraConvergeWithOrderTwoInL2) {
  const Material material{0.02, 0.3};
  const double coarse = solve(bubble(material), material, 10).l2;
  const double fine = solve(bubble(material), material, 20).l2;
  const double order = std::log2(coarse / fine);
  std::printf("relative L2 error %.4g with 10 cells, %.4g with 20: order %.3f\n", coarse, fine, order);
  EXPECT_NEAR(order, 2.0, 0.1);
  EXPECT_LT(fine, 0.02);
}

TEST(TissueConvergence, LinearTetrahedraLockAsPoissonApproachesOneHalf) {
  double before = 1.0;
  for (const double poisson : {0.3, 0.45, 0.49, 0.499, 0.4999}) {
    const Material material{0.02, poisson};
    const double softness = solve(incompressible(material), material, 12).softness;
    std::printf("Poisson ratio %-6g: %.3f of the exact compliance\n", poisson, softness);
    EXPECT_LT(softness, before);  // stiffer at every step, and never too soft
    before = softness;
  }
  EXPECT_LT(before, 0.2);
}

}  // namespace
}  // namespace stylet
