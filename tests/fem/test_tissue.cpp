// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"

#include <random>
#include <thread>

namespace stylet {
namespace {

using test::build;
using test::nodes_where;
using test::relative_error;

const Material kGland{0.040, 0.45};
const Material kFat{0.008, 0.49};

TetMesh jittered() { return box_mesh({-20, 10, 30}, {20, 50, 90}, {4, 5, 6}, 0.15); }

std::vector<Index> floor_nodes(const TetMesh& mesh) {
  double lowest = mesh.nodes.front().z();
  for (const Vec3& x : mesh.nodes) lowest = std::min(lowest, x.z());
  return nodes_where(mesh, [lowest](const Vec3& x) { return x.z() == lowest; });
}

VecX random_forces(const Tissue& tissue, unsigned seed) {
  std::mt19937 random(seed);
  VecX f(3 * Eigen::Index{tissue.displacement_nodes()});
  for (double& value : f) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
  return f;
}

// A tissue of two regions: gland within 60 mm of the origin, fat elsewhere.
Tissue two_regions(Element element) {
  TetMesh mesh = jittered();
  assign_regions(mesh, {"fat", "gland"}, [](const Vec3& x) { return x.norm() > 60 ? 0 : 1; });
  const auto fixed = floor_nodes(mesh);
  return build(std::move(mesh), {kFat, kGland}, fixed, element);
}

// The jittered box with its floor held, and its stiffness for nodes away from the floor.
struct Held {
  Tissue tissue;
  std::vector<Index> inner;  // nodes whose rows of K involve no fixed node
  Held(const Material& material, Element element)
      : tissue(build(jittered(), {material}, floor_nodes(jittered()), element)) {
    // An averaged change of volume couples two rings of elements.
    std::vector<char> near_support(static_cast<std::size_t>(tissue.displacement_nodes()), 0);
    for (const Index a : tissue.fixed_nodes()) near_support[a] = 1;
    for (int ring = 0; ring < 2; ++ring) {
      const auto before = near_support;
      for (Index t = 0; t < tissue.mesh().tet_count(); ++t) {
        const auto nodes = tissue.nodes_of(t);
        if (std::none_of(nodes.begin(), nodes.end(), [&](Index a) { return before[a]; })) continue;
        for (const Index a : nodes) near_support[a] = 1;
      }
    }
    for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
      if (!near_support[a]) inner.push_back(a);
    }
  }

  // K u at the inner nodes, whose rows involve free nodes only.
  VecX forces(const VecX& u) const {
    VecX free(tissue.free_dofs());
    for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
      if (!tissue.is_fixed(a)) free.segment<3>(tissue.first_dof(a)) = u.segment<3>(3 * Eigen::Index{a});
    }
    const VecX f = tissue.stiffness() * free;
    VecX out(3 * static_cast<Eigen::Index>(inner.size()));
    for (std::size_t i = 0; i < inner.size(); ++i) {
      out.segment<3>(3 * static_cast<Eigen::Index>(i)) = f.segment<3>(tissue.first_dof(inner[i]));
    }
    return out;
  }
};

using EveryElement = test::ElementTest;
STYLET_FOR_EVERY_ELEMENT(EveryElement);

TEST_P(EveryElement, stiffness_is_symmetric_to_the_last_bit_and_positive_definite) {
  const Tissue tissue = two_regions(GetParam());
  const Eigen::SparseMatrix<double>& K = tissue.stiffness();
  const Eigen::SparseMatrix<double> difference = K - Eigen::SparseMatrix<double>(K.transpose());
  EXPECT_EQ(difference.norm(), 0.0);
  EXPECT_EQ(K.rows(), tissue.free_dofs());
  for (unsigned seed = 0; seed < 10; ++seed) {
    const VecX u = random_forces(tissue, seed).head(K.rows());
    EXPECT_GT(u.dot(K * u), 0.0);
  }
}

TEST(Tissue, element_block_is_the_second_derivative_of_the_strain_energy) {
  const TetMesh mesh = jittered();
  const auto g = barycentric_gradients(mesh, 77);
  const double volume = tet_volume(mesh, 77);
  const auto energy = [&](const Eigen::Matrix<double, 3, 4>& u) {
    const Mat3 gradient = u * g.transpose();
    const Mat3 strain = 0.5 * (gradient + gradient.transpose());
    return 0.5 * volume * test::stress_of(kGland, gradient).cwiseProduct(strain).sum();
  };
  // The energy is a quadratic form, so its differences W(p + q) − W(p) − W(q) are exact.
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const Mat3 block = element_block(g, volume, kGland, a, b);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          Eigen::Matrix<double, 3, 4> p = Eigen::Matrix<double, 3, 4>::Zero();
          Eigen::Matrix<double, 3, 4> q = p;
          p(i, a) = 1.0;
          q(j, b) = 1.0;
          EXPECT_NEAR(block(i, j), energy(p + q) - energy(p) - energy(q), 1e-14);
        }
      }
    }
  }
}

TEST_P(EveryElement, patch_test_every_linear_field_is_in_equilibrium_with_its_tractions) {
  const Held body(kGland, GetParam());
  for (int entry = 0; entry < 9; ++entry) {
    Mat3 gradient = Mat3::Zero();
    gradient(entry / 3, entry % 3) = 0.02;
    const VecX u = test::sample(body.tissue, [&](const Vec3& x) { return Vec3(gradient * x + Vec3(1, 2, 3)); });
    const Mat3 stress = test::stress_of(kGland, gradient);
    const VecX all = test::traction_by_region(body.tissue, {stress});
    VecX expected(3 * static_cast<Eigen::Index>(body.inner.size()));
    for (std::size_t i = 0; i < body.inner.size(); ++i) {
      expected.segment<3>(3 * static_cast<Eigen::Index>(i)) = all.segment<3>(3 * Eigen::Index{body.inner[i]});
    }
    EXPECT_LT(relative_error(body.forces(u), expected), 1e-10) << entry;
  }
}

TEST_P(EveryElement, patch_test_a_linear_field_is_reproduced_under_its_tractions) {
  const Tissue tissue = build(jittered(), {kGland}, floor_nodes(jittered()), GetParam());
  const TetMesh& mesh = tissue.mesh();
  for (const Vec3& c : {Vec3(0.03, 0, 0), Vec3(0, -0.02, 0), Vec3(0, 0, 0.01), Vec3(0.01, 0.02, -0.03)}) {
    const Mat3 gradient = c * Vec3::UnitZ().transpose();
    const VecX expected = test::sample(tissue, [&](const Vec3& x) { return Vec3(c * (x.z() - 30.0)); });
    const Mat3 stress = test::stress_of(kGland, gradient);
    const VecX u = tissue.solve(test::traction_by_region(tissue, {stress}));
    EXPECT_LT(relative_error(u, expected), 1e-10);
    const MatX stresses = tissue.stress(u);
    VecX voigt(6);
    voigt << stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(1, 2), stress(2, 0);
    for (Index t = 0; t < mesh.tet_count(); ++t) EXPECT_LT(relative_error(stresses.col(t), voigt), 1e-10);
  }
}

TEST_P(EveryElement, rigid_motions_give_no_stress_and_no_forces) {
  const Held body(kFat, GetParam());
  for (int mode = 0; mode < 6; ++mode) {
    const Vec3 axis = Vec3::Unit(mode % 3);
    const VecX u =
        test::sample(body.tissue, [&](const Vec3& x) { return mode < 3 ? axis : Vec3(axis.cross(x) / 60.0); });
    // Compare with the stiffest diagonal entry times the motion.
    const double scale = body.tissue.stiffness().diagonal().maxCoeff() * u.cwiseAbs().maxCoeff();
    EXPECT_LT(body.forces(u).cwiseAbs().maxCoeff(), 1e-10 * scale);
    EXPECT_LT(body.tissue.support_forces(u).cwiseAbs().maxCoeff(), 1e-10 * scale);
    EXPECT_LT(body.tissue.stress(u).cwiseAbs().maxCoeff(), 1e-10 * kFat.lambda() * u.cwiseAbs().maxCoeff());
  }
}

TEST_P(EveryElement, uniaxial_bar_stretches_by_force_times_length_over_stiffness) {
  // Without lateral contraction, the held end does not disturb the field.
  const Material material{0.020, 0.0};
  TetMesh mesh = box_mesh({0, 0, 0}, {10, 15, 100}, {2, 3, 20}, 0.15);
  const auto fixed = floor_nodes(mesh);
  const Tissue tissue = build(std::move(mesh), {material}, fixed, GetParam());
  const double force = 0.6;
  Mat3 stress = Mat3::Zero();
  stress(2, 2) = force / (10.0 * 15.0);
  const VecX u = tissue.solve(test::traction_by_region(tissue, {stress}));
  const double elongation = force * 100.0 / (material.young_MPa * 150.0);
  const VecX expected = test::sample(tissue, [&](const Vec3& x) { return Vec3(0, 0, elongation * x.z() / 100); });
  EXPECT_LT(relative_error(u, expected), 1e-10);
}

TEST_P(EveryElement, two_materials_in_series_carry_the_same_traction) {
  // Jitter only across the bar, so that the interface between the materials stays flat.
  TetMesh mesh = box_mesh({0, 0, 0}, {20, 20, 60}, {4, 4, 12}, 0.15);
  const TetMesh flat = box_mesh({0, 0, 0}, {20, 20, 60}, {4, 4, 12});
  for (Index a = 0; a < mesh.node_count(); ++a) mesh.nodes[a].z() = flat.nodes[a].z();
  assign_regions(mesh, {"gland", "fat"}, [](const Vec3& x) { return x.z() < 25.0 ? 0 : 1; });
  const auto fixed = floor_nodes(mesh);
  const std::vector<Material> materials{kGland, kFat};
  const Tissue tissue = build(std::move(mesh), materials, fixed, GetParam());

  // u = c_r z within each material, with the traction σ e_z = (λ + μ) (c·e_z) e_z + μ c common to both.
  const Vec3 common(2e-4, -1e-4, 5e-4);
  std::vector<Vec3> slope;
  std::vector<Mat3> stress;
  for (const Material& m : materials) {
    slope.emplace_back(common.x() / m.mu(), common.y() / m.mu(), common.z() / (m.lambda() + 2 * m.mu()));
    stress.push_back(test::stress_of(m, slope.back() * Vec3::UnitZ().transpose()));
  }
  ASSERT_LT((stress[0].col(2) - stress[1].col(2)).norm(), 1e-15);
  const VecX expected = test::sample(tissue, [&](const Vec3& x) {
    return Vec3(slope[0] * std::min(x.z(), 25.0) + slope[1] * std::max(x.z() - 25.0, 0.0));
  });
  EXPECT_LT(relative_error(tissue.solve(test::traction_by_region(tissue, stress)), expected), 1e-10);
}

TEST_P(EveryElement, support_forces_balance_the_loads) {
  const Tissue tissue = two_regions(GetParam());
  VecX f = random_forces(tissue, 3);
  for (const Index a : tissue.fixed_nodes()) f.segment<3>(3 * Eigen::Index{a}).setZero();
  const VecX r = tissue.support_forces(tissue.solve(f));
  EXPECT_LT((test::resultant(f) + test::resultant(r)).norm(), 1e-9 * test::resultant(f).norm());
  const Vec3 torque = test::moment(tissue, f);
  EXPECT_LT((torque + test::moment(tissue, r)).norm(), 1e-9 * torque.norm());
  for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
    if (tissue.is_fixed(a)) continue;
    EXPECT_EQ((r.segment<3>(3 * Eigen::Index{a})), Vec3::Zero());
  }
}

TEST_P(EveryElement, solves_many_loads_at_once_as_one_by_one_and_ignores_loads_on_supports) {
  const Tissue tissue = build(jittered(), {kGland}, floor_nodes(jittered()), GetParam());
  MatX f(3 * Eigen::Index{tissue.displacement_nodes()}, 200);
  for (Eigen::Index k = 0; k < f.cols(); ++k) f.col(k) = random_forces(tissue, static_cast<unsigned>(k));
  const MatX u = tissue.solve(f);
  for (const Eigen::Index k : {0, 63, 191, 192, 199})
    EXPECT_LT(relative_error(tissue.solve(f.col(k)), u.col(k)), 1e-12);
  for (const Index a : tissue.fixed_nodes()) {
    EXPECT_EQ(u.middleRows<3>(3 * Eigen::Index{a}).norm(), 0.0);
    f.middleRows<3>(3 * Eigen::Index{a}).setZero();
  }
  EXPECT_EQ((tissue.solve(f) - u).norm(), 0.0);
  EXPECT_EQ(tissue.solve(MatX(f.rows(), 0)).cols(), 0);
}

TEST_P(EveryElement, gives_the_same_bits_in_every_build_and_in_every_thread) {
  const Tissue first = build(jittered(), {kGland}, floor_nodes(jittered()), GetParam());
  const Tissue second = build(jittered(), {kGland}, floor_nodes(jittered()), GetParam());
  const VecX f = random_forces(first, 1);
  const MatX u = first.solve(f);
  EXPECT_EQ((second.solve(f) - u).norm(), 0.0);
  std::vector<MatX> seen(4);
  {
    std::vector<std::jthread> threads;
    for (MatX& out : seen) {
      threads.emplace_back([&] {
        for (int i = 0; i < 20; ++i) out = first.solve(f);
      });
    }
  }
  for (const MatX& out : seen) EXPECT_EQ((out - u).norm(), 0.0);
}

TEST_P(EveryElement, elements_of_fixed_nodes_only_are_legal) {
  const TetMesh mesh = jittered();
  const auto fixed = nodes_where(mesh, [](const Vec3& x) { return x.z() < 52.0; });
  const Tissue tissue = build(mesh, {kGland}, fixed, GetParam());
  EXPECT_EQ(tissue.free_dofs(), 3 * (tissue.displacement_nodes() - static_cast<Index>(tissue.fixed_nodes().size())));
  EXPECT_TRUE(std::includes(tissue.fixed_nodes().begin(), tissue.fixed_nodes().end(), fixed.begin(), fixed.end()));
  EXPECT_TRUE(tissue.solve(random_forces(tissue, 5)).allFinite());
}

TEST(Tissue, repeated_and_unsorted_supports_are_taken_once) {
  const TetMesh mesh = jittered();
  auto fixed = floor_nodes(mesh);
  const auto sorted = fixed;
  std::reverse(fixed.begin(), fixed.end());
  fixed.push_back(fixed.front());
  EXPECT_EQ(build(mesh, {kGland}, fixed).fixed_nodes(), sorted);
}

// Fill-reducing orderings draw random numbers: those of one thread must not disturb those of another.
TEST(Tissue, has_the_same_bits_when_several_are_built_at_once) {
  const auto displacement = [] {
    TetMesh mesh = box_mesh({0, 0, 0}, {50, 50, 50}, {13, 13, 13}, 0.15);
    const auto fixed = nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
    const Tissue tissue = build(std::move(mesh), {{0.01, 0.49}}, fixed);
    MatX f = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, 1);
    f.bottomRows<3>().setOnes();
    return tissue.solve(f);
  };
  const MatX alone = displacement();
  for (int round = 0; round < 5; ++round) {
    std::vector<MatX> together(4);
    {
      std::vector<std::jthread> threads;
      for (MatX& one : together) threads.emplace_back([&one, &displacement] { one = displacement(); });
    }
    for (const MatX& one : together) ASSERT_EQ(one, alone);
  }
}

}  // namespace
}  // namespace stylet
