// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/beam_shape.hpp"
#include "needle/beam_tangent.hpp"
#include "needle/rotation_terms.hpp"
#include "support.hpp"

#include <cmath>
#include <functional>

namespace stylet {
namespace {

using beam::BeamShape;
using beam::BeamTangent;
using beam::ElementKind;
using beam::RotationTerms;
using test::kShort;
using test::tilted;

/// Loads inside elements, on their borders, at the tip, and at and before the clamp, in no order on purpose.
std::vector<PointLoad> assorted_loads() {
  return {{97.3, {0.21, -0.4, 0.13}}, {kShort, {-0.3, 0.25, -0.5}}, {3.1, {1.1, -0.6, 0.4}}, {60.0, {0.2, 0.3, -0.9}},
          {61.7, {-0.5, 0.1, 0.3}},   {0.0, {2.0, 1.0, -3.0}},      {-5.0, {1.0, 1.0, 1.0}}};
}

/// A shape curved in 3D whose elements rotate by up to the given angle [rad].
BeamShape curved(int elements, double angle, ElementKind kind = ElementKind::arc) {
  BeamShape shape(elements, kShort, 15700.0, 12100.0, kind);
  for (Eigen::Index i = 0; i < shape.curvature.size(); ++i) {
    shape.curvature[i] = angle / shape.element_length() * std::sin(1.7 * static_cast<double>(i) + 0.4) / std::sqrt(3.0);
  }
  shape.update();
  return shape;
}

double potential(const BeamShape& shape, const Mat3& base, const std::vector<PointLoad>& loads) {
  double value = shape.energy();
  for (const PointLoad& load : loads) value -= load.force.dot(base * shape.point(load.s));
  return value;
}

VecX gradient(const BeamShape& shape, const Mat3& base, const std::vector<PointLoad>& loads) {
  BeamTangent tangent(shape, 8);
  tangent.assemble(shape, base, loads);
  return tangent.gradient();
}

/// Fourth-order central difference of a vector function with respect to curvature component i.
template <class Function>
auto difference(BeamShape shape, Eigen::Index i, double h, Function&& function) {
  const double centre = shape.curvature[i];
  const auto at = [&](double offset) {
    shape.curvature[i] = centre + offset;
    shape.update();
    return function(shape);
  };
  using Value = decltype(at(h));
  const Value near_plus = at(h);
  const Value near_minus = at(-h);
  const Value far_plus = at(2 * h);
  const Value far_minus = at(-2 * h);
  return Value((8.0 * (near_plus - near_minus) - (far_plus - far_minus)) / (12.0 * h));
}

TEST(StumpffFunctions, meet_their_recurrence_and_the_circular_functions_at_any_size) {
  for (const double x : {0.0, 1e-12, 1e-4, 0.3, 1.0, 3.999, 4.001, 20.0, 400.0}) {
    const auto c = beam::stumpff(x);
    const double theta = std::sqrt(x);
    EXPECT_NEAR(c[0], std::cos(theta), 4e-15) << x;
    EXPECT_NEAR(c[1], x == 0.0 ? 1.0 : std::sin(theta) / theta, 4e-15) << x;
    double factorial = 1.0;
    for (int k = 0; k <= 5; ++k) {
      if (k > 0) factorial *= k;
      EXPECT_NEAR(x * c[k + 2], 1.0 / factorial - c[k], 4e-15) << x << ' ' << k;
    }
  }
}

TEST(RotationTerms, agree_with_the_angle_axis_formula_and_its_mean) {
  for (const double angle : {1e-9, 1e-3, 0.3, 1.5, 2.5, 7.0}) {
    const Vec3 axis = Vec3(0.3, -0.5, 0.8).normalized();
    const RotationTerms terms(angle * axis);
    EXPECT_LT((terms.rotation() - Eigen::AngleAxisd(angle, axis).toRotationMatrix()).norm(), 1e-14) << angle;
    // Gauss–Legendre quadrature with 5 points on each of 16 intervals.
    const double node[] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
    const double weight[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                             0.2369268850561891};
    Mat3 mean = Mat3::Zero();
    for (int i = 0; i < 16; ++i) {
      for (int k = 0; k < 5; ++k) {
        const double sigma = (i + 0.5 + 0.5 * node[k]) / 16.0;
        mean += weight[k] / 32.0 * Eigen::AngleAxisd(sigma * angle, axis).toRotationMatrix();
      }
    }
    EXPECT_LT((terms.mean_rotation() - mean).norm(), 1e-14) << angle;
    EXPECT_LT((terms.chord() - mean.col(2)).norm(), 1e-14) << angle;
  }
}

/// Derivatives of arcs, which a beam consists of, and of rods.
class BeamDerivatives : public testing::TestWithParam<ElementKind> {};

TEST_P(BeamDerivatives, gradient_is_the_derivative_of_the_potential_energy) {
  const auto loads = assorted_loads();
  for (const double angle : {0.0, 1e-6, 0.05, 0.3, 1.0, 2.4}) {
    const BeamShape shape = curved(8, angle, GetParam());
    const VecX exact = gradient(shape, tilted(), loads);
    for (Eigen::Index i = 0; i < exact.size(); ++i) {
      const double numeric =
          difference(shape, i, 1e-4, [&](const BeamShape& s) { return potential(s, tilted(), loads); });
      EXPECT_NEAR(exact[i], numeric, 2e-8 * exact.norm()) << "component " << i << ", element rotation " << angle;
    }
  }
}

TEST_P(BeamDerivatives, hessian_is_the_derivative_of_the_gradient_and_symmetric) {
  const auto loads = assorted_loads();
  for (const double angle : {0.0, 1e-6, 0.05, 0.3, 1.0, 2.4}) {
    const BeamShape shape = curved(8, angle, GetParam());
    BeamTangent tangent(shape, 8);
    tangent.assemble(shape, tilted(), loads);
    const MatX exact = tangent.hessian();
    for (Eigen::Index i = 0; i < exact.cols(); ++i) {
      const VecX numeric = difference(shape, i, 1e-4, [&](const BeamShape& s) { return gradient(s, tilted(), loads); });
      EXPECT_LT((exact.col(i) - numeric).norm(), 1e-8 * exact.norm()) << "column " << i << ", rotation " << angle;
    }
  }
}

TEST_P(BeamDerivatives, residual_is_the_largest_element_gradient_per_unit_length) {
  const auto loads = assorted_loads();
  const BeamShape shape = curved(8, 0.3, GetParam());
  const VecX g = gradient(shape, tilted(), loads);
  double largest = 0.0;
  for (int e = 0; e < 8; ++e) largest = std::max(largest, g.segment<3>(3 * e).norm() / shape.element_length());
  BeamTangent tangent(shape, 8);
  EXPECT_NEAR(tangent.largest_imbalance(shape, tilted(), loads), largest, 1e-11 * largest);
}

TEST_P(BeamDerivatives, compliances_and_steps_equal_the_dense_formulae) {
  const auto loads = assorted_loads();
  for (const int elements : {5, 8, 24, 40}) {
    BeamShape shape = curved(elements, 0.1, GetParam());
    BeamTangent tangent(shape, 8);
    const Mat3 base = tilted();
    tangent.assemble(shape, base, loads);
    const auto size = 3 * static_cast<Eigen::Index>(loads.size());
    MatX compliance(size, size);
    VecX free(size);
    tangent.condense(compliance, free);

    MatX J(size, 3 * elements);
    for (Eigen::Index i = 0; i < J.cols(); ++i) {
      J.col(i) = difference(shape, i, 1e-4, [&](const BeamShape& s) {
        VecX points(size);
        for (std::size_t c = 0; c < loads.size(); ++c) {
          points.segment<3>(3 * static_cast<Eigen::Index>(c)) = base * s.point(loads[c].s);
        }
        return points;
      });
    }
    const MatX H = tangent.hessian();
    ASSERT_EQ(tangent.elastic_shift(), 0.0);
    const MatX inverse = H.inverse();
    const MatX expected = J * inverse * J.transpose();
    EXPECT_LT((compliance - expected).norm(), 1e-8 * expected.norm()) << elements;
    EXPECT_EQ((compliance - compliance.transpose()).norm(), 0.0);
    const VecX motion = -J * inverse * tangent.gradient();
    EXPECT_LT((free - motion).norm(), 1e-8 * motion.norm()) << elements;

    auto changed = loads;
    VecX df(size);
    for (std::size_t c = 0; c < loads.size(); ++c) {
      const Vec3 delta(0.01 * static_cast<double>(c), -0.02, 0.03);
      changed[c].force += delta;
      df.segment<3>(3 * static_cast<Eigen::Index>(c)) = delta;
    }
    const VecX before = shape.curvature;
    const VecX expected_step = inverse * (J.transpose() * df - tangent.gradient());
    tangent.step(changed, shape);
    EXPECT_LT((shape.curvature - before - expected_step).norm(), 1e-8 * expected_step.norm()) << elements;
  }
}

TEST(BeamTangent, stays_positive_definite_far_beyond_buckling) {
  for (const double push : {3.0, 20.0, 500.0}) {
    BeamShape shape = curved(24, 0.01);
    BeamTangent tangent(shape, 2);
    const std::vector<PointLoad> loads = {{kShort, {0.0, 0.0, -push}}, {50.0, {0.1, 0.0, 0.0}}};
    tangent.assemble(shape, Mat3::Identity(), loads);
    ASSERT_LT(tangent.hessian().selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0) << push;
    EXPECT_GT(tangent.elastic_shift(), 0.0);
    MatX compliance(6, 6);
    VecX free(6);
    tangent.condense(compliance, free);
    EXPECT_TRUE(compliance.allFinite());
    EXPECT_GT(compliance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
    // The step decreases the energy.
    const VecX before = shape.curvature;
    const VecX g = tangent.gradient();
    tangent.step(loads, shape);
    EXPECT_LT(g.dot(shape.curvature - before), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, BeamDerivatives, testing::Values(ElementKind::arc, ElementKind::rod),
                         [](const auto& kind) { return kind.param == ElementKind::arc ? "arcs" : "rods"; });

}  // namespace
}  // namespace stylet
