// SPDX-License-Identifier: GPL-3.0-or-later
// The contribution of hats to the compliance, against one system of base nodes and hats.
#include "coupling/track/added_hats.hpp"

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include <random>

using namespace stylet;

namespace {

constexpr double kHatsRounding = 1e-12;
constexpr int kVertices = 4;  ///< base nodes, each of which is an observable
constexpr int kSplits = 3;
constexpr int kPoint = kVertices;     ///< observable half way between vertices 0 and 1
constexpr int kNode = kVertices + 1;  ///< observable at the node of the last split, which is inside an element
constexpr int kObservables = kNode + 1;

/// Base nodes with a stiffness K, and hats that are coupled to them: two with a border, then one inside an element.
class CoupledHats : public testing::Test {
 protected:
  CoupledHats() : hats(kObservables, kSplits) {
    const MatX root = MatX::NullaryExpr(n, n, [&] { return number(); });
    K = root * root.transpose() + 4.0 * MatX::Identity(n, n);
    K_inverse = K.ldlt().solve(MatX::Identity(n, n));
    weights.setZero(n, 3 * kObservables);
    weights.leftCols(n).setIdentity();
    for (const int vertex : {0, 1}) weights.block<3, 3>(3 * vertex, 3 * kPoint) = 0.5 * Mat3::Identity();
    for (const int vertex : {2, 3}) weights.block<3, 3>(3 * vertex, 3 * kNode) = 0.5 * Mat3::Identity();
    for (int p = 0; p < kSplits; ++p) {
      std::vector<Border> border;
      if (p < kSplits - 1) border = {{p, block()}, {p + 1, block()}, {kVertices - 1, block()}};
      borders.push_back(border);
      const Mat3 root_of_hat = block();
      stiffness.push_back(root_of_hat * root_of_hat.transpose() + 3.0 * Mat3::Identity());
    }
    for (int o = 0; o < kObservables; ++o) hats.clear(o);
    hats.set_node(kNode, kSplits - 1);
  }

  double number() { return uniform(random); }
  Mat3 block() {
    return Mat3::NullaryExpr([&] { return number(); });
  }

  /// Displacement of an observable by a split's border through the base compliance: Σ_j K⁻¹(x,j) k_jp.
  [[nodiscard]] Mat3 base(int observable, int split) const {
    Mat3 sum = Mat3::Zero();
    for (const Border& border : borders[static_cast<std::size_t>(split)])
      sum += base_compliance(observable, border.vertex) * border.k;
    return sum;
  }
  [[nodiscard]] Mat3 base_compliance(int a, int b) const {
    return weights.middleCols<3>(3 * a).transpose() * K_inverse * weights.middleCols<3>(3 * b);
  }
  void extend(int observable) {
    while (hats.known(observable) < hats.count()) hats.extend_z(observable, base(observable, hats.known(observable)));
  }
  void add(int split) {
    const auto& border = borders[static_cast<std::size_t>(split)];
    const Mat3& k_pp = stiffness[static_cast<std::size_t>(split)];
    if (border.empty()) {
      hats.add_inside(k_pp);
      return;
    }
    for (const Border& at : border) extend(at.vertex);
    hats.add_bordered(border);
    for (const Border& at : border) extend(at.vertex);
    hats.complete(border, k_pp);
  }

  /// Compliance between two observables with the first `splits` hats, from one large system.
  [[nodiscard]] Mat3 solved_at_once(int a, int b, int splits) const {
    const Eigen::Index size = n + 3 * splits;
    MatX system = MatX::Zero(size, size);
    system.topLeftCorner(n, n) = K;
    for (int p = 0; p < splits; ++p) {
      system.block<3, 3>(n + 3 * p, n + 3 * p) = stiffness[static_cast<std::size_t>(p)];
      for (const Border& border : borders[static_cast<std::size_t>(p)]) {
        system.block<3, 3>(3 * border.vertex, n + 3 * p) = border.k;
        system.block<3, 3>(n + 3 * p, 3 * border.vertex) = border.k.transpose();
      }
    }
    const auto of = [&](int observable) {
      MatX columns = MatX::Zero(size, 3);
      columns.topRows(n) = weights.middleCols<3>(3 * observable);
      if (observable == kNode && splits == kSplits) columns.bottomRows<3>() = Mat3::Identity();
      return columns;
    };
    return of(a).transpose() * system.ldlt().solve(of(b));
  }

  const Eigen::Index n = 3 * kVertices;
  std::mt19937_64 random{5};
  std::uniform_real_distribution<double> uniform{-0.5, 0.5};
  MatX K;
  MatX K_inverse;
  MatX weights;  ///< (n × 3 observables) weights of the base nodes in each observable
  std::vector<std::vector<Border>> borders;
  std::vector<Mat3> stiffness;
  AddedHats hats;
};

}  // namespace

TEST_F(CoupledHats, add_to_the_compliance_what_a_system_with_them_has) {
  for (int splits = 1; splits <= kSplits; ++splits) {
    add(splits - 1);
    ASSERT_EQ(hats.count(), splits);
    for (int o = 0; o < kObservables; ++o) extend(o);
    for (int a = 0; a < kObservables; ++a) {
      for (int b = 0; b < kObservables; ++b) {
        const Mat3 expected = solved_at_once(a, b, splits);
        EXPECT_LE((hats.compliance(a, b, base_compliance(a, b)) - expected).norm(), kHatsRounding) << a << ' ' << b;
        hats.load(b);
        EXPECT_LE((base_compliance(a, b) + hats.moved(a) - expected).norm(), kHatsRounding) << a << ' ' << b;
      }
    }
  }
  EXPECT_FALSE(hats.inside(0));
  EXPECT_TRUE(hats.inside(kSplits - 1));
}

TEST_F(CoupledHats, reach_an_interpolated_observable_as_those_it_is_interpolated_from) {
  for (int p = 0; p < kSplits; ++p) add(p);
  for (int o = 0; o < kObservables; ++o) extend(o);
  const std::array<int, 2> ends{0, 1};
  const std::array<double, 2> halves{0.5, 0.5};
  for (int p = 0; p < kSplits; ++p) {
    const Mat3 before = hats.z(kPoint, p);
    hats.interpolate_z(kPoint, p, 0.0, ends, halves);
    EXPECT_LE((hats.z(kPoint, p) - before).norm(), kHatsRounding);
  }
  EXPECT_EQ(hats.known(kPoint), kSplits);
  // So a force there does the same as that force distributed over the others.
  hats.load_beyond(kPoint, ends, halves);
  for (int o = 0; o < kObservables; ++o) EXPECT_LE(hats.moved(o).norm(), kHatsRounding);
}

TEST_F(CoupledHats, are_the_same_for_observables_at_one_place) {
  for (int p = 0; p < 2; ++p) add(p);
  extend(2);
  hats.clear(kPoint);
  hats.copy_z(2, kPoint);
  EXPECT_EQ(hats.known(kPoint), 2);
  for (int p = 0; p < 2; ++p) EXPECT_EQ(hats.z(kPoint, p), hats.z(2, p));
}

TEST_F(CoupledHats, inside_elements_act_on_what_they_reach_and_on_nothing_else) {
  AddedHats inside(kObservables, kSplits);
  for (int o = 0; o < kObservables; ++o) inside.clear(o);
  inside.set_node(kNode, 0);
  inside.add_inside(2.0 * Mat3::Identity());
  inside.add_hats(kPoint, kNode, 0.25);  // interpolated from this node and others
  for (const int o : {0, kPoint, kNode}) inside.extend_z(o, Mat3::Zero());
  const Mat3 base = block();
  EXPECT_EQ(inside.compliance(0, kNode, base), base);
  EXPECT_EQ(inside.compliance(kNode, kNode, Mat3::Zero()), 0.5 * Mat3::Identity());
  EXPECT_EQ(inside.compliance(kPoint, kNode, Mat3::Zero()), 0.125 * Mat3::Identity());
  inside.load(kPoint);
  EXPECT_EQ(inside.moved(0), Mat3::Zero());
  EXPECT_EQ(inside.moved(kNode), 0.125 * Mat3::Identity());
}

TEST_F(CoupledHats, are_forgotten_by_reset) {
  for (int round = 0; round < 2; ++round) {
    for (int p = 0; p < 2; ++p) add(p);
    extend(kPoint);
    EXPECT_LE(
        (hats.compliance(kPoint, kPoint, base_compliance(kPoint, kPoint)) - solved_at_once(kPoint, kPoint, 2)).norm(),
        kHatsRounding);
    hats.reset();
    EXPECT_EQ(hats.count(), 0);
    EXPECT_EQ(hats.known(kPoint), 0);
  }
}
