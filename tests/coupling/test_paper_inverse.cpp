// SPDX-License-Identifier: GPL-3.0-or-later
// The full inverse of Goksel et al. 2005, updated in place: correct values, and the costs of the updates.
#include "stylet/coupling/paper/inverse_compliance.hpp"
#include "stylet/coupling/track_compliance.hpp"

#include "two_region_block.hpp"

#include <Eigen/LU>

#include <cmath>
#include <random>

using namespace stylet;
using namespace stylet::paper;
using stylet::test::Block;

namespace {

/// A stiffness matrix of N unknowns, a symmetric change of it on k of them, and both inverses.
struct Example {
  Example(Eigen::Index N, Eigen::Index k) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const auto matrix = [&](Eigen::Index rows, Eigen::Index columns) {
      MatX m(rows, columns);
      for (double& x : m.reshaped()) x = normal(random);
      return m;
    };
    const MatX root = matrix(N, N);
    const MatX K = root * root.transpose() / static_cast<double>(N) + MatX::Identity(N, N);
    const MatX part = matrix(k, k);
    change = 0.1 * (part + part.transpose());
    MatX after = K;
    for (Eigen::Index i = 0; i < k; ++i) dofs.push_back(static_cast<Index>((7 * i + 3) % N));
    for (Eigen::Index i = 0; i < k; ++i)
      for (Eigen::Index j = 0; j < k; ++j)
        after(dofs[static_cast<std::size_t>(i)], dofs[static_cast<std::size_t>(j)]) += change(i, j);
    before_inverse = K.inverse();
    after_inverse = after.inverse();
  }
  std::vector<Index> dofs;
  MatX change;
  MatX before_inverse;
  MatX after_inverse;
};

double relative(const MatX& a, const MatX& b) { return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff(); }

/// The present mesh, inverted from scratch, in the order of the inverse that was updated in place.
MatX fresh_inverse(const Block& block, const InverseCompliance& changed) {
  const TetMesh mesh = changed.mesh().materialise();
  EXPECT_TRUE(check_mesh(mesh, "changed mesh").ok());
  auto fresh = Tissue::build(mesh, block.materials, block.fixed);
  EXPECT_TRUE(fresh.ok());
  const MatX inverse = full_inverse(*fresh);
  MatX ordered(inverse.rows(), inverse.cols());
  std::vector<Index> from(static_cast<std::size_t>(inverse.rows()));
  for (Index node = 0; node < mesh.node_count(); ++node) {
    if (changed.first_dof(node) < 0) continue;
    for (Index axis = 0; axis < 3; ++axis)
      from[static_cast<std::size_t>(changed.first_dof(node) + axis)] = fresh->first_dof(node) + axis;
  }
  for (Index i = 0; i < ordered.rows(); ++i)
    for (Index j = 0; j < ordered.cols(); ++j)
      ordered(i, j) = inverse(from[static_cast<std::size_t>(i)], from[static_cast<std::size_t>(j)]);
  return ordered;
}

double difference_to_fresh(const Block& block, const InverseCompliance& changed) {
  const MatX reference = fresh_inverse(block, changed);
  MatX ours(reference.rows(), reference.cols());
  for (Index i = 0; i < ours.rows(); ++i)
    for (Index j = 0; j < ours.cols(); ++j) ours(i, j) = changed.inverse()(i, j);
  return relative(ours, reference);
}

InverseCompliance full(const Block& block, DenseInverse::Engine engine, bool move_nodes, int capacity = 120) {
  return {block.tissue, *block.locator, std::make_shared<const MatX>(full_inverse(*block.tissue)),
          engine,       move_nodes,     capacity};
}

Vec3 somewhere(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(2.0, 38.0);
  return {place(random), place(random), place(random)};
}

/// A point anywhere in the block, or on a face of its element.
struct Place {
  MaterialPoint at;
  Vec3 x;
  Vec3 out;  ///< across the face
};
Place place(const Block& block, std::mt19937_64& random, Placement placement) {
  Place p;
  p.x = somewhere(random);
  p.at = block.locator->find(p.x).value();
  p.out = Vec3::UnitZ();
  if (placement != Placement::face) return p;
  const int local = static_cast<int>(random() % 4);
  p.at.weights[local] = 0.0;
  p.at.weights /= p.at.weights.sum();
  p.x.setZero();
  for (int i = 0; i < 4; ++i) {
    const auto corner = block.tissue->mesh().tets[static_cast<std::size_t>(p.at.tet)][static_cast<std::size_t>(i)];
    p.x += p.at.weights[i] * block.tissue->mesh().nodes[static_cast<std::size_t>(corner)];
  }
  p.out = block.locator->face_normal(p.at.tet, local);
  return p;
}

}  // namespace

TEST(PaperInverse, switches_and_woodbury_both_give_the_inverse_of_the_changed_stiffness) {
  const Example e(60, 9);
  MatX inverse = e.before_inverse;
  update_by_switches<double>(inverse, e.dofs, e.change, 60);
  EXPECT_LT(relative(inverse, e.after_inverse), 1e-12);
  inverse = e.before_inverse;
  EXPECT_LT(update_by_woodbury<double>(inverse, e.dofs, e.change), 1e3);
  EXPECT_LT(relative(inverse, e.after_inverse), 1e-12);
  inverse = e.before_inverse;
  update_by_woodbury_symmetric(inverse, e.dofs, e.change);
  inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  EXPECT_LT(relative(inverse, e.after_inverse), 1e-12);
}

TEST(PaperInverse, a_switch_there_and_back_changes_nothing_and_one_way_solves_the_mixed_problem) {
  const Example e(20, 3);
  MatX M = e.before_inverse;
  std::vector<double> left(20);
  std::vector<double> right(20);
  switch_axis<double>(M, 4, left, right);
  switch_axis<double>(M, 11, left, right);
  // Forces at displacement-controlled rows, displacements at force-controlled rows.
  VecX force = VecX::LinSpaced(20, -1.0, 1.0);
  const VecX u = e.before_inverse * force;
  VecX known = force;
  VecX unknown = u;
  for (const int i : {4, 11}) std::swap(known[i], unknown[i]);
  EXPECT_LT((M * known - unknown).norm(), 1e-12 * unknown.norm());
  switch_axis<double>(M, 11, left, right);
  switch_axis<double>(M, 4, left, right);
  EXPECT_LT(relative(M, e.before_inverse), 1e-12);
}

TEST(PaperInverse, counted_multiplications_are_those_the_paper_states) {
  constexpr Eigen::Index N = 150;
  for (const Eigen::Index k : {9, 18}) {
    const Example e(N, k);
    const Matrix<Counted> change = e.change.cast<Counted>();
    Matrix<Counted> inverse = e.before_inverse.cast<Counted>();
    Counted::reset();
    update_by_switches<Counted>(inverse, e.dofs, change, N);
    EXPECT_EQ(Counted::multiplications, static_cast<std::uint64_t>(2 * k * (N * N + N)));
    EXPECT_NEAR(static_cast<double>(Counted::multiplications) / cost_of_switches(N, static_cast<double>(k)), 1.0, 0.01);

    inverse = e.before_inverse.cast<Counted>();
    Counted::reset();
    update_by_woodbury<Counted>(inverse, e.dofs, change);
    EXPECT_NEAR(static_cast<double>(Counted::multiplications),
                static_cast<double>(k * N * N + k * k * N + 3 * k * k * k), static_cast<double>(2 * k * k));
    EXPECT_NEAR(static_cast<double>(Counted::multiplications) / cost_of_woodbury(N, static_cast<double>(k)), 1.0, 0.02);
    for (Eigen::Index i = 0; i < N; ++i)
      for (Eigen::Index j = 0; j < N; ++j) EXPECT_NEAR(inverse(i, j).value, e.after_inverse(i, j), 1e-9);
  }
}

TEST(PaperInverse, a_singular_change_leaves_the_inverse_as_it_was) {
  MatX inverse = MatX::Identity(4, 4);
  const MatX before = inverse;
  const std::vector<Index> dofs{2};
  const MatX change = MatX::Constant(1, 1, -1.0);
  EXPECT_TRUE(std::isinf(update_by_woodbury_symmetric(inverse, dofs, change)));
  EXPECT_EQ(inverse, before);
}

class BothEngines : public testing::TestWithParam<DenseInverse::Engine> {};

TEST_P(BothEngines, hundred_added_nodes_equal_a_fresh_inverse) {
  const Block block;
  for (const Placement placement : {Placement::interior, Placement::face}) {
    InverseCompliance changed = full(block, GetParam(), false);
    std::mt19937_64 random(3);
    while (changed.remeshing().size() < 100) {
      const Place p = place(block, random, placement);
      changed.add(p.at, p.x, placement, p.out);
    }
    EXPECT_LT(difference_to_fresh(block, changed), 1e-8);
    for (const RemeshEvent& event : changed.remeshing())
      EXPECT_TRUE(event.dimension == 15 || (placement == Placement::face && event.dimension == 18)) << event.dimension;
  }
}

TEST_P(BothEngines, hundred_repositioned_or_added_nodes_equal_a_fresh_inverse) {
  const Block block(5);
  InverseCompliance changed = full(block, GetParam(), true);
  std::mt19937_64 random(9);
  std::vector<int> dimensions;
  int moved = 0;
  while (changed.remeshing().size() < 100) {
    const Vec3 x = somewhere(random);
    const auto at = block.locator->find(x);
    ASSERT_TRUE(at);
    const auto before = changed.mesh().positions();
    if (changed.add(*at, x, Placement::interior).point < 0) continue;
    const RemeshEvent& event = changed.remeshing().back();
    if (event.kind == RemeshEvent::Kind::repositioned) {
      ++moved;
      dimensions.push_back(event.dimension);
      EXPECT_FALSE(changed.mesh().on_boundary(event.node));
      EXPECT_EQ(changed.mesh().position(event.node), x);
      EXPECT_NEAR(event.moved_mm, (before[static_cast<std::size_t>(event.node)] - x).norm(), 1e-12);
    } else {
      EXPECT_NE(event.refused, RemeshEvent::Refused::no);
      EXPECT_EQ(event.dimension, 15);
    }
  }
  EXPECT_GT(moved, 15);
  // The size of ΔK depends on the number of elements that meet at the node.
  EXPECT_NE(*std::min_element(dimensions.begin(), dimensions.end()),
            *std::max_element(dimensions.begin(), dimensions.end()));
  EXPECT_LT(difference_to_fresh(block, changed), 1e-8);
}

TEST_P(BothEngines, the_condensed_engine_gives_the_same_compliances) {
  const Block block(5);
  for (const Placement placement : {Placement::interior, Placement::face}) {
    InverseCompliance whole = full(block, GetParam(), false);
    TrackCompliance condensed(block.store, *block.locator, 60);
    std::mt19937_64 random(21);
    for (int tries = 0; tries < 60; ++tries) {
      const Place p = place(block, random, placement);
      const Placement how = tries % 5 == 4 ? Placement::embedded : placement;
      const auto a = whole.add(p.at, p.x, how, p.out);
      const auto b = condensed.add(p.at, p.x, how, p.out);
      ASSERT_EQ(a.point, b.point);
      ASSERT_EQ(a.refusal, b.refusal);
    }
    const Vec3 tip(20.3, 19.1, 17.7);
    const auto at = block.locator->find(tip);
    whole.move_tip(*at, tip);
    condensed.move_tip(*at, tip);
    const Eigen::Index size = 3 * whole.points();
    EXPECT_GT(size, 60);
    EXPECT_LT(relative(whole.matrix().topLeftCorner(size, size), condensed.matrix().topLeftCorner(size, size)), 1e-10);
    ASSERT_EQ(whole.remeshing().size(), condensed.remeshing().size());
    for (std::size_t k = 0; k < whole.remeshing().size(); ++k)
      EXPECT_EQ(whole.remeshing()[k].dimension, condensed.remeshing()[k].dimension);

    MatX forces = MatX::Random(3, whole.points());
    EXPECT_LT(relative(whole.displacement(forces), condensed.displacement(forces)), 1e-10);
    EXPECT_LT(relative(whole.gradient_at_tip(forces), condensed.gradient_at_tip(forces)), 1e-10);
    // The forces that the supports bear; loads on held nodes cause no deformation.
    const auto reaction = [&](const ContactCompliance::Nodes& nodes) {
      VecX r = VecX::Zero(3 * block.tissue->mesh().node_count());
      for (const Index node : block.fixed)
        r.segment<3>(3 * node) = nodes.support.segment<3>(3 * node) - nodes.load.segment<3>(3 * node);
      return r;
    };
    EXPECT_LT(relative(reaction(whole.nodes(forces)), reaction(condensed.nodes(forces))), 1e-10);
  }
}

TEST_P(BothEngines, reset_brings_the_initial_inverse_back_bit_for_bit) {
  const Block block;
  InverseCompliance changed = full(block, GetParam(), true);
  const MatX before = full_inverse(*block.tissue);
  std::mt19937_64 random(2);
  for (int k = 0; k < 20; ++k) {
    const Vec3 x = somewhere(random);
    changed.add(*block.locator->find(x), x, Placement::interior);
  }
  changed.reset();
  EXPECT_EQ(changed.inverse().dofs(), before.rows());
  for (Index i = 0; i < before.rows(); ++i)
    for (Index j = 0; j <= i; ++j) ASSERT_EQ(changed.inverse()(i, j), before(i, j));
  EXPECT_EQ(changed.mesh().node_count(), block.tissue->mesh().node_count());
  EXPECT_EQ(changed.remeshing().size(), 0u);
}

INSTANTIATE_TEST_SUITE_P(PaperInverse, BothEngines,
                         testing::Values(DenseInverse::Engine::bcs, DenseInverse::Engine::woodbury),
                         [](const auto& engine) {
                           return engine.param == DenseInverse::Engine::bcs ? "bcs" : "woodbury";
                         });

TEST(PaperInverse, springs_of_the_size_of_the_tissue_keep_the_small_matrix_well_conditioned) {
  // The paper gives new rows a very large diagonal entry and watches the condition number. Removing the springs'
  // stiffness again makes any diagonal entry exact, so none has to be large.
  const Block block;
  const auto initial = std::make_shared<const MatX>(full_inverse(*block.tissue));
  double error[2] = {0.0, 0.0};
  const Vec3 x(20.3, 19.1, 17.7);
  for (int k = 0; k < 2; ++k) {
    DenseInverse inverse(DenseInverse::Engine::woodbury, initial, 1);
    inverse.set_springs(k == 0 ? 1.0 : 1e9);
    // A node inside an element, by hand: its own stiffness only, as if its neighbours were fixed.
    const Index first = inverse.append_node();
    const std::vector<Index> dofs{first, first + 1, first + 2};
    const MatX stiffness = 0.37 * MatX::Identity(3, 3);
    inverse.change(dofs, stiffness);
    error[k] = std::abs(inverse(first, first) * 0.37 - 1.0);
  }
  EXPECT_LT(error[0], 1e-14);
  EXPECT_GT(error[1], 1e-10);  // only nine of sixteen digits are correct
  EXPECT_LT(error[1], 1e-6);

  InverseCompliance good = full(block, DenseInverse::Engine::woodbury, false);
  MaterialPoint middle = *block.locator->find(x);
  middle.weights.setConstant(0.25);
  Vec3 centre = Vec3::Zero();
  for (const Index node : block.tissue->mesh().tets[static_cast<std::size_t>(middle.tet)])
    centre += 0.25 * block.tissue->mesh().nodes[static_cast<std::size_t>(node)];
  good.add(middle, centre, Placement::interior);
  ASSERT_EQ(good.remeshing().size(), 1u);
  EXPECT_LT(good.remeshing()[0].condition, 1e3);
}
