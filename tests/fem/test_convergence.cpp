// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"
#include "evidence/validate/quadrature.hpp"

#include <cstdio>
#include <numbers>

namespace stylet {
namespace {

constexpr double kSide_mm = 60.0;
constexpr double kPi = std::numbers::pi;

// A displacement field that vanishes on the surface of the cube, with the body force −div σ [N/mm³] that causes it.
struct Manufactured {
  std::function<Vec3(const Vec3&)> displacement;
  std::function<Vec3(const Vec3&)> body_force;
  std::function<double(const Vec3&)> divergence;
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
          },
          [=](const Vec3& x) {
            const Vec3 s = (k * x).array().sin();
            const Vec3 c = (k * x).array().cos();
            return k * (d.x() * c.x() * s.y() * s.z() + d.y() * s.x() * c.y() * s.z() + d.z() * s.x() * s.y() * c.z());
          }};
}

// A flow without change of volume, u = curl of (0, 0, S(x) S(y) sin(πz/L)) with S = sin²(π·/L). Its body force −μ Δu
// depends on Poisson's ratio only through μ, so any loss of displacement is locking.
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
          },
          [](const Vec3&) { return 0.0; }};
}

struct Errors {
  double l2;        // ‖u_h − u‖ / ‖u‖ in L2
  double softness;  // work of the load on u_h / work on u: 1 without error, below 1 when too stiff
  double pressure;  // as l2, for tr σ / 3 at the centroid of each element
};

Errors solve(const Manufactured& problem, const Material& material, int cells, Element element) {
  TetMesh mesh = box_mesh({0, 0, 0}, Vec3::Constant(kSide_mm), {cells, cells, cells}, 0.1);
  const auto fixed =
      test::nodes_where(mesh, [](const Vec3& x) { return (x.array() == 0.0).any() || (x.array() == kSide_mm).any(); });
  const Tissue tissue = test::build(std::move(mesh), {material}, fixed, element);
  const auto rule = validate::tetrahedron_rule(4);
  // Calls visit(place, volume, shape) for every quadrature point.
  const auto for_each_point = [&](const auto& visit) {
    for (Index t = 0; t < tissue.mesh().tet_count(); ++t) {
      const double volume = tet_volume(tissue.mesh(), t);
      for (const auto& point : rule) {
        Vec3 x = Vec3::Zero();
        for (int a = 0; a < 4; ++a) x += point.weights[a] * tissue.mesh().nodes[tissue.mesh().tets[t][a]];
        visit(x, volume * point.factor, tissue.shape(t, point.weights));
      }
    }
  };

  VecX f = VecX::Zero(3 * Eigen::Index{tissue.displacement_nodes()});
  double work = 0.0;
  for_each_point([&](const Vec3& x, double volume, const Shape& shape) {
    const Vec3 force = volume * problem.body_force(x);
    for (int i = 0; i < shape.count; ++i) f.segment<3>(3 * Eigen::Index{shape.node[i]}) += shape.weight[i] * force;
    work += force.dot(problem.displacement(x));
  });
  const VecX u = tissue.solve(f);
  const double work_h = f.dot(u);

  double error = 0.0;
  double norm = 0.0;
  for_each_point([&](const Vec3& x, double volume, const Shape& shape) {
    Vec3 u_h = Vec3::Zero();
    for (int i = 0; i < shape.count; ++i) u_h += shape.weight[i] * u.segment<3>(3 * Eigen::Index{shape.node[i]});
    const Vec3 exact = problem.displacement(x);
    error += volume * (u_h - exact).squaredNorm();
    norm += volume * exact.squaredNorm();
  });

  double pressure_error = 0.0;
  double pressure_norm = 0.0;
  const MatX stress = tissue.stress(u);
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const Index a : tissue.mesh().tets[t]) middle += 0.25 * tissue.mesh().nodes[a];
    const double volume = tet_volume(tissue.mesh(), t);
    const double exact = (material.lambda() + 2.0 / 3.0 * material.mu()) * problem.divergence(middle);
    pressure_error += volume * std::pow(stress.col(t).head<3>().mean() - exact, 2);
    pressure_norm += volume * exact * exact;
  }
  return {std::sqrt(error / norm), work_h / work, std::sqrt(pressure_error / pressure_norm)};
}

struct Order {
  double order;  // order of the L2 error when the cells are halved
  double fine;   // the smaller error
};

Order order_of(Element element, double poisson, int cells) {
  const Material material{0.02, poisson};
  const double coarse = solve(bubble(material), material, cells, element).l2;
  const double fine = solve(bubble(material), material, 2 * cells, element).l2;
  std::printf("%s, Poisson ratio %g: relative L2 error %.4g with %d cells, %.4g with %d: order %.3f\n",
              to_string(element), poisson, coarse, cells, fine, 2 * cells, std::log2(coarse / fine));
  return {std::log2(coarse / fine), fine};
}

TEST(TissueConvergence, linear_tetrahedra_converge_with_order_two_in_l2) {
  const Order result = order_of(Element::p1, 0.3, 10);
  EXPECT_NEAR(result.order, 2.0, 0.1);
  EXPECT_LT(result.fine, 0.02);
}

TEST(TissueConvergence, averaged_pressure_converges_with_order_two_in_l2) {
  EXPECT_NEAR(order_of(Element::nodal_pressure, 0.45, 8).order, 2.0, 0.1);
  // The order is still falling towards two, because the error starts from a larger value.
  EXPECT_GT(order_of(Element::nodal_pressure, 0.499, 8).order, 1.9);
}

TEST(TissueConvergence, quadratic_tetrahedra_converge_with_order_three_in_l2) {
  EXPECT_NEAR(order_of(Element::p2, 0.3, 5).order, 3.0, 0.1);
}

TEST(TissueConvergence, linear_tetrahedra_lock_as_poisson_approaches_one_half) {
  double before = 1.0;
  for (const double poisson : {0.3, 0.45, 0.49, 0.499, 0.4999}) {
    const Material material{0.02, poisson};
    const double softness = solve(incompressible(material), material, 12, Element::p1).softness;
    std::printf("p1, Poisson ratio %-6g: %.3f of the exact compliance\n", poisson, softness);
    EXPECT_LT(softness, before);  // stiffer at every step, and never too soft
    before = softness;
  }
  EXPECT_LT(before, 0.2);
}

// Relative loss of displacement of a flow without change of volume between the Poisson ratios 0.3 and `poisson`.
double lost_compliance(Element element, int cells, double poisson) {
  const Material plain{0.02, 0.3};
  const Material nearly{0.02, poisson};
  const double before = solve(incompressible(plain), plain, cells, element).softness;
  const double after = solve(incompressible(nearly), nearly, cells, element).softness;
  std::printf("%s: %.3f of the exact compliance at 0.3, %.3f at %g\n", to_string(element), before, after, poisson);
  return 1.0 - after / before;
}

TEST(TissueConvergence, averaged_pressure_and_quadratic_tetrahedra_do_not_lock) {
  EXPECT_LT(lost_compliance(Element::nodal_pressure, 12, 0.499), 0.02);
  EXPECT_LT(lost_compliance(Element::p2, 10, 0.499), 0.05);
}

double indentation(const Material& material, int cells, Element element) {
  return validate::press_block(material, cells, element).value().dent_mm;
}

TEST(NearlyIncompressibleBlock, is_as_soft_as_a_fine_mesh_says_with_every_element_but_the_linear) {
  const Material nearly{0.02, 0.499};
  const double reference = indentation(nearly, 12, Element::p2);
  const double averaged = indentation(nearly, 16, Element::nodal_pressure);
  const double quadratic = indentation(nearly, 8, Element::p2);
  const double linear = indentation(nearly, 16, Element::p1);
  std::printf(
      "fine reference %.4f mm; nodal-pressure %.4f (%+.2f %%), p2 on half as many cells %.4f (%+.2f %%), p1 %.4f "
      "(%+.0f %%)\n",
      reference, averaged, 100 * (averaged / reference - 1), quadratic, 100 * (quadratic / reference - 1), linear,
      100 * (linear / reference - 1));
  EXPECT_NEAR(averaged, reference, 0.02 * reference);
  EXPECT_NEAR(quadratic, reference, 0.02 * reference);
  EXPECT_LT(linear, 0.8 * reference);
}

// The displacement does not restrain pressures that alternate from node to node (equal orders are not stable in the
// sense of Babuška and Brezzi). On a smooth problem such pressures must not appear.
TEST(TissueConvergence, averaged_pressure_itself_converges) {
  const Material material{0.02, 0.499};
  const double coarse = solve(bubble(material), material, 8, Element::nodal_pressure).pressure;
  const double fine = solve(bubble(material), material, 16, Element::nodal_pressure).pressure;
  std::printf("relative L2 error of the pressure %.4g with 8 cells, %.4g with 16: order %.2f\n", coarse, fine,
              std::log2(coarse / fine));
  EXPECT_GT(std::log2(coarse / fine), 1.0);
}

}  // namespace
}  // namespace stylet
