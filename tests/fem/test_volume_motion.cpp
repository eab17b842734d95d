// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/volume_motion.hpp"

#include "bodies.hpp"
#include "evidence/validate/quadrature.hpp"
#include "stylet/geom/locator.hpp"

#include <Eigen/QR>

#include <random>

namespace stylet {
namespace {

using Accuracy = VolumeResponse::Accuracy;
using test::build;
using test::ElementTest;
using test::nodes_where;
using test::sample;

constexpr double kHeight_mm = 40.0;
constexpr double kLower_mm = 10.0;  // the volume lies between these heights
constexpr double kUpper_mm = 20.0;

/// A bar along z, held at its lower end, with a slice of it as the second region.
TetMesh sliced_bar(std::array<int, 3> cells) {
  TetMesh mesh = box_mesh({0, 0, 0}, {20, 20, kHeight_mm}, cells);
  assign_regions(mesh, {"body", "slice"}, [](const Vec3& x) { return x.z() > kLower_mm && x.z() < kUpper_mm ? 1 : 0; });
  return mesh;
}

Tissue bar(const TetMesh& mesh, double young_MPa, double poisson, Element element) {
  return build(mesh, {{young_MPa, poisson}, {young_MPa, poisson}},
               nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }), element);
}

constexpr std::array<int, 1> kSlice{1};

struct PointForce {
  MaterialPoint at;
  Vec3 force;
};

VolumeMotion motion_by(const VolumeResponse& response, const std::vector<PointForce>& forces) {
  VolumeMotion motion;
  for (const PointForce& f : forces) response.add(f.at, f.force, motion);
  return motion;
}

/// Mean displacement of the volume per force at a point [mm/N].
Mat3 mean_per_force(const VolumeResponse& response, const MaterialPoint& at) {
  Mat3 mean;
  for (int k = 0; k < 3; ++k) mean.col(k) = motion_by(response, {{at, Vec3::Unit(k)}}).shift_mm;
  return mean;
}

/// Displacement caused by forces [mm] (3 × displacement nodes).
VecX displacement(const Tissue& tissue, const std::vector<PointForce>& forces) {
  VecX load = VecX::Zero(3 * Eigen::Index{tissue.displacement_nodes()});
  for (const PointForce& f : forces) {
    const Shape shape = tissue.shape(f.at.tet, f.at.weights);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
      load.segment<3>(3 * Eigen::Index{shape.node[i]}) += shape.weight[i] * f.force;
  }
  return tissue.solve(load);
}

/// Motion of the slice, computed by integrating a displacement over it; its thirds are layers of elements. The rigid
/// motion is fitted to the displacement at the quadrature points by least squares.
VolumeMotion integrated(const Tissue& tissue, const VecX& u) {
  const TetMesh& mesh = tissue.mesh();
  VolumeMotion motion;
  std::array<double, 3> volumes{};
  std::vector<Eigen::Matrix<double, 3, 6>> rows;
  std::vector<Vec3> moved;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (mesh.tet_region[static_cast<std::size_t>(t)] != 1) continue;
    for (const validate::TetrahedronPoint& point : validate::tetrahedron_rule(4)) {
      const double dv = point.factor * tet_volume(mesh, t);
      Vec3 x = Vec3::Zero(), at = Vec3::Zero(), middle = Vec3::Zero();
      for (int i = 0; i < 4; ++i) {
        const Vec3& corner =
            mesh.nodes[static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)])];
        x += point.weights[i] * corner;
        middle += 0.25 * corner;
      }
      const Shape shape = tissue.shape(t, point.weights);
      const ShapeGradients gradients = tissue.shape_gradients(t, point.weights);
      for (int i = 0; i < shape.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        at += shape.weight[k] * u.segment<3>(3 * Eigen::Index{shape.node[k]});
        motion.dilation += dv * gradients.gradient.col(i).dot(u.segment<3>(3 * Eigen::Index{gradients.node[k]}));
      }
      const auto third = static_cast<std::size_t>(3.0 * (kUpper_mm - middle.z()) / (kUpper_mm - kLower_mm));
      motion.shift_mm += dv * at;
      motion.third_mm[third] += dv * at;
      volumes[third] += dv;
      Eigen::Matrix<double, 3, 6> row;
      row.leftCols<3>().setIdentity();
      for (int k = 0; k < 3; ++k) row.col(3 + k) = Vec3::Unit(k).cross(x);
      rows.emplace_back(std::sqrt(dv) * row);
      moved.emplace_back(std::sqrt(dv) * at);
    }
  }
  const double volume = volumes[0] + volumes[1] + volumes[2];
  motion.shift_mm /= volume;
  motion.dilation /= volume;
  for (std::size_t third = 0; third < 3; ++third) motion.third_mm[third] /= volumes[third];
  MatX fit(3 * static_cast<Eigen::Index>(rows.size()), 6);
  VecX right(fit.rows());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    fit.middleRows<3>(3 * static_cast<Eigen::Index>(k)) = rows[k];
    right.segment<3>(3 * static_cast<Eigen::Index>(k)) = moved[k];
  }
  motion.rotation_rad = VecX(fit.colPivHouseholderQr().solve(right)).tail<3>();
  return motion;
}

void expect_equal(const VolumeMotion& a, const VolumeMotion& b, double tolerance) {
  EXPECT_LT((a.shift_mm - b.shift_mm).norm(), tolerance * b.shift_mm.norm());
  EXPECT_LT((a.rotation_rad - b.rotation_rad).norm(), tolerance * b.rotation_rad.norm());
  for (std::size_t third = 0; third < 3; ++third)
    EXPECT_LT((a.third_mm[third] - b.third_mm[third]).norm(), tolerance * b.third_mm[third].norm()) << third;
  EXPECT_NEAR(a.dilation, b.dilation, tolerance * std::abs(b.dilation));
}

class VolumeMotionBy : public ElementTest {};

TEST_P(VolumeMotionBy, forces_is_that_of_the_displacement_they_cause) {
  const TetMesh mesh = sliced_bar({3, 3, 12});  // the thirds of the slice are layers of elements
  const Tissue tissue = bar(mesh, 0.01, 0.45, GetParam());
  const auto response = VolumeResponse::solve(tissue, kSlice, Accuracy::of_the_tissue);
  ASSERT_TRUE(response) << response.error().message();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> some(-1.0, 1.0);
  std::uniform_int_distribution<Index> element(0, mesh.tet_count() - 1);
  for (int repeat = 0; repeat < 5; ++repeat) {
    std::vector<PointForce> forces;
    for (int k = 0; k < 7; ++k) {
      Vec4 weights = Vec4::NullaryExpr([&] { return 1.0 + some(random); });
      weights /= weights.sum();
      forces.push_back({{element(random), weights}, Vec3::NullaryExpr([&] { return some(random); })});
    }
    expect_equal(motion_by(*response, forces), integrated(tissue, displacement(tissue, forces)), 1e-8);
  }
}

/// Forces on the displacement nodes that cause a given displacement, which is zero where the bar is held.
std::vector<PointForce> forces_for(const Tissue& tissue, const VecX& u) {
  VecX free(tissue.free_dofs());
  for (Index node = 0; node < tissue.displacement_nodes(); ++node) {
    if (tissue.first_dof(node) >= 0) free.segment<3>(tissue.first_dof(node)) = u.segment<3>(3 * Eigen::Index{node});
  }
  const VecX f = tissue.stiffness() * free;
  std::vector<PointForce> forces;
  std::vector<char> done(static_cast<std::size_t>(tissue.displacement_nodes()), 0);
  const TetMesh& mesh = tissue.mesh();
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto& corners = mesh.tets[static_cast<std::size_t>(t)];
    for (const Index node : tissue.nodes_of(t)) {
      if (std::exchange(done[static_cast<std::size_t>(node)], 1) != 0 || tissue.first_dof(node) < 0) continue;
      Vec4 weights = Vec4::Zero();
      for (const Index end : tissue.ends_of(node))
        weights[std::find(corners.begin(), corners.end(), end) - corners.begin()] += 0.5;
      forces.push_back({{t, weights}, f.segment<3>(tissue.first_dof(node))});
    }
  }
  return forces;
}

// The slice rotates and swells as a whole. The borders of its thirds do not coincide with element borders.
TEST_P(VolumeMotionBy, forces_that_turn_and_swell_it_is_the_turn_and_the_swelling) {
  const TetMesh mesh = sliced_bar({2, 3, 8});
  const Tissue tissue = bar(mesh, 0.01, 0.3, GetParam());
  const auto response = VolumeResponse::solve(tissue, kSlice, Accuracy::of_the_tissue);
  ASSERT_TRUE(response) << response.error().message();
  const Vec3 shift(0.3, -0.2, 0.5), turn(0.01, -0.02, 0.03), about(4.0, 9.0, 12.0);
  constexpr double swelling = 0.01;  // relative growth of every length
  const auto field = [&](const Vec3& x) -> Vec3 {
    return x.z() == 0.0 ? Vec3::Zero() : Vec3(shift + turn.cross(x - about) + swelling * (x - about));
  };
  const VolumeMotion motion = motion_by(*response, forces_for(tissue, sample(tissue, field)));
  const Vec3 centre(10.0, 10.0, 15.0);
  EXPECT_LT((motion.shift_mm - field(centre)).norm(), 1e-8);
  EXPECT_LT((motion.rotation_rad - turn).norm(), 1e-8);
  EXPECT_NEAR(motion.dilation, 3.0 * swelling, 1e-8);
  constexpr double third = (kUpper_mm - kLower_mm) / 3.0;
  EXPECT_LT((motion.third_mm[VolumeMotion::superior] - field(centre + third * Vec3::UnitZ())).norm(), 1e-8);
  EXPECT_LT((motion.third_mm[VolumeMotion::middle] - field(centre)).norm(), 1e-8);
  EXPECT_LT((motion.third_mm[VolumeMotion::inferior] - field(centre - third * Vec3::UnitZ())).norm(), 1e-8);
}

// A linear displacement that rotates by sin θ about an axis n also stretches the body; finite() makes it Rodrigues'
// rotation.
TEST_P(VolumeMotionBy, forces_that_turn_it_far_is_the_whole_turn_when_it_is_made_finite) {
  const TetMesh mesh = sliced_bar({2, 3, 8});
  const Tissue tissue = bar(mesh, 0.01, 0.3, GetParam());
  const auto response = VolumeResponse::solve(tissue, kSlice, Accuracy::of_the_tissue);
  ASSERT_TRUE(response) << response.error().message();
  const Vec3 shift(0.3, -0.2, 0.5), axis = Vec3(1.0, -2.0, 0.5).normalized(), centre(10.0, 10.0, 15.0);
  constexpr double third = (kUpper_mm - kLower_mm) / 3.0;
  for (const double angle : {1e-4, 0.1, 0.7, 1.5}) {
    const auto field = [&](const Vec3& x) -> Vec3 {
      return x.z() == 0.0 ? Vec3::Zero() : Vec3(shift + std::sin(angle) * axis.cross(x - centre));
    };
    const VolumeMotion motion = response->finite(motion_by(*response, forces_for(tissue, sample(tissue, field))));
    const Mat3 R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const auto turned = [&](double z) -> Vec3 { return shift + (R - Mat3::Identity()) * (z * Vec3::UnitZ()); };
    EXPECT_LT((motion.shift_mm - shift).norm(), 1e-8) << angle;
    EXPECT_LT((motion.rotation_rad - angle * axis).norm(), 1e-6) << angle;
    EXPECT_LT((motion.third_mm[VolumeMotion::superior] - turned(third)).norm(), 1e-7) << angle;
    EXPECT_LT((motion.third_mm[VolumeMotion::middle] - shift).norm(), 1e-7) << angle;
    EXPECT_LT((motion.third_mm[VolumeMotion::inferior] - turned(-third)).norm(), 1e-7) << angle;
  }
}

STYLET_FOR_EVERY_ELEMENT(VolumeMotionBy);

// Without Poisson's effect, a force F on a whole cross-section at height z moves a point at height x by F min(x,
// z)/(EA). The mean over the slice has a closed form that is quadratic in z inside it, and quadratic elements represent
// it exactly.
TEST(VolumeResponse, of_a_bar_is_its_theory_with_quadratic_elements_whatever_the_step_uses) {
  constexpr double young = 0.01;
  const TetMesh mesh = sliced_bar({2, 2, 8});
  const Tissue tissue = bar(mesh, young, 0.0, Element::p1);
  const Topology topology(mesh);
  const Locator locator(mesh, topology);
  for (const Accuracy accuracy : {Accuracy::quadratic, Accuracy::quadratic_halved}) {
    const auto response = VolumeResponse::solve(tissue, kSlice, accuracy);
    ASSERT_TRUE(response) << response.error().message();
    for (const double z : {3.0, 9.0, 12.0, 16.5, 20.0, 33.0}) {
      const auto at = locator.find(Vec3(6.0, 7.0, z));
      ASSERT_TRUE(at);
      const double lower = std::min(z, kLower_mm);
      const double upper = std::min(z, kUpper_mm);
      const double within = 0.5 * (upper * upper - lower * lower) + (kUpper_mm - upper) * z - (kLower_mm - lower) * z;
      const double expected = within / (kUpper_mm - kLower_mm) / (young * 20.0 * 20.0);
      EXPECT_NEAR(mean_per_force(*response, *at)(2, 2), expected, 1e-9 * expected) << "at height " << z;
    }
  }
}

// The remaining discretisation error becomes smaller with either way of improving the elements.
TEST(VolumeResponse, comes_nearer_to_that_of_a_fine_mesh_with_quadratic_elements_and_with_halved_edges) {
  const auto along_z = [](std::array<int, 3> cells, Accuracy accuracy) {
    const TetMesh mesh = sliced_bar(cells);
    const Tissue tissue = bar(mesh, 0.01, 0.49, Element::p1);
    const auto response = VolumeResponse::solve(tissue, kSlice, accuracy);
    const Topology topology(mesh);
    const Locator locator(mesh, topology);
    return mean_per_force(response.value(), *locator.find(Vec3(9.0, 11.0, 31.0)))(2, 2);
  };
  const double fine = along_z({6, 6, 12}, Accuracy::quadratic);
  const double own = std::abs(along_z({2, 2, 4}, Accuracy::of_the_tissue) - fine);
  const double quadratic = std::abs(along_z({2, 2, 4}, Accuracy::quadratic) - fine);
  const double halved = std::abs(along_z({2, 2, 4}, Accuracy::quadratic_halved) - fine);
  EXPECT_LT(quadratic, 0.5 * own);
  EXPECT_LT(halved, 0.5 * quadratic);
}

// Compares the iteration on quadratic elements with the solution by their factor.
TEST(VolumeResponse, on_quadratic_elements_is_that_of_their_factor) {
  const TetMesh mesh = sliced_bar({3, 3, 6});
  for (const double poisson : {0.0, 0.45, 0.49, 0.4999}) {
    const Tissue linear = bar(mesh, 0.01, poisson, Element::p1);
    const Tissue quadratic = bar(mesh, 0.01, poisson, Element::p2);
    const auto iterated = VolumeResponse::solve(linear, kSlice, Accuracy::quadratic);
    const auto factorised = VolumeResponse::solve(quadratic, kSlice, Accuracy::of_the_tissue);
    ASSERT_TRUE(iterated) << iterated.error().message();
    ASSERT_TRUE(factorised) << factorised.error().message();
    for (Index tet = 0; tet < mesh.tet_count(); tet += 7) {
      const std::vector<PointForce> forces{{{tet, Vec4(0.1, 0.2, 0.3, 0.4)}, Vec3(0.3, -0.2, 0.5)}};
      SCOPED_TRACE(testing::Message() << poisson << ", element " << tet);
      const VolumeMotion expected = motion_by(*factorised, forces);
      const VolumeMotion motion = motion_by(*iterated, forces);
      EXPECT_LT((motion.shift_mm - expected.shift_mm).norm(), 1e-7 * expected.shift_mm.norm());
      EXPECT_LT((motion.rotation_rad - expected.rotation_rad).norm(), 1e-6 * expected.rotation_rad.norm());
      for (std::size_t third = 0; third < 3; ++third)
        EXPECT_LT((motion.third_mm[third] - expected.third_mm[third]).norm(), 1e-7 * expected.third_mm[third].norm());
      EXPECT_NEAR(motion.dilation, expected.dilation, 1e-6 * expected.rotation_rad.norm());
    }
  }
}

TEST(VolumeResponse, of_nothing_is_nothing) {
  const TetMesh mesh = sliced_bar({2, 2, 4});
  const Tissue tissue = bar(mesh, 0.01, 0.3, Element::p1);
  for (const Accuracy accuracy : {Accuracy::of_the_tissue, Accuracy::quadratic}) {
    const auto response = VolumeResponse::solve(tissue, {}, accuracy);
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_FALSE(response->has(VolumeMotion::superior));
    const VolumeMotion motion = motion_by(*response, {{{0, Vec4::Constant(0.25)}, Vec3(1.0, 2.0, 3.0)}});
    EXPECT_TRUE(motion.shift_mm.isZero(0.0));
    EXPECT_TRUE(motion.rotation_rad.isZero(0.0));
    EXPECT_TRUE(motion.third_mm[VolumeMotion::middle].isZero(0.0));
    EXPECT_EQ(motion.dilation, 0.0);
  }
}

}  // namespace
}  // namespace stylet
