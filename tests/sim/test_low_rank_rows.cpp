// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/low_rank_rows.hpp"
#include "support/count_allocations.hpp"

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include <cmath>
#include <random>

using namespace stylet;

namespace {

constexpr Eigen::Index kColumns = 150;
constexpr std::size_t kNodes = 3000;

std::vector<Vec3> points_in_a_box() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-50.0, 50.0);
  std::vector<Vec3> points(kNodes);
  for (Vec3& x : points) x = {any(random), any(random), any(random)};
  return points;
}

/// Displacement of points by forces along a line: similar to 1/r, but finite.
Eigen::MatrixXf smooth(const std::vector<Vec3>& points) {
  Eigen::MatrixXf A(3 * static_cast<Eigen::Index>(points.size()), kColumns);
  for (Eigen::Index j = 0; j < kColumns; ++j) {
    const Vec3 source(0.0, 0.0, -50.0 + 100.0 * static_cast<double>(j) / static_cast<double>(kColumns));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 r = points[i] - source;
      A.col(j).segment<3>(3 * static_cast<Eigen::Index>(i)) =
          (Vec3(r.x() * r.z(), r.y() * r.z(), r.squaredNorm() + r.z() * r.z()) / std::pow(r.squaredNorm() + 4.0, 1.5))
              .cast<float>();
    }
  }
  return A;
}

Eigen::MatrixXf rough() {
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  Eigen::MatrixXf A(3 * static_cast<Eigen::Index>(kNodes), kColumns);
  for (float& value : A.reshaped()) value = normal(random);
  return A;
}

/// Largest error of the products of all nodes' rows with random unit vectors.
double largest_error(const LowRankRows& rows, const Eigen::MatrixXf& A) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  auto product = rows.make_product();
  double worst = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    for (float& value : product.vector()) value = normal(random);
    product.vector().normalize();
    product.forget();
    for (Index node = 0; node < static_cast<Index>(kNodes); ++node) {
      const Eigen::Vector3f expected = A.middleRows<3>(3 * Eigen::Index{node}) * product.vector();
      worst = std::max(worst, static_cast<double>((rows.times(node, product) - expected).norm()));
    }
  }
  return worst;
}

std::size_t bytes(const Eigen::MatrixXf& M) { return static_cast<std::size_t>(M.size()) * sizeof(float); }

}  // namespace

TEST(LowRankRows, keeps_smooth_rows_in_a_fraction_of_the_room_and_within_its_tolerance) {
  const auto points = points_in_a_box();
  const Eigen::MatrixXf A = smooth(points);
  double before = 1.0;
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    const LowRankRows rows(points, A, tolerance);
    const double share = static_cast<double>(rows.bytes()) / static_cast<double>(bytes(A));
    EXPECT_LT(share, 0.5) << tolerance;
    EXPECT_LT(largest_error(rows, A), tolerance);
    if (tolerance < 0.1) {
      EXPECT_GT(share, before) << "room for a tolerance that was not asked for";
    }
    before = share;
  }
}

TEST(LowRankRows, the_worst_vector_for_a_cluster_is_within_the_tolerance) {
  auto points = points_in_a_box();
  points.resize(500);  // one cluster
  const Eigen::MatrixXf A = smooth(points);
  const double tolerance = 0.01;
  const LowRankRows rows(points, A, tolerance);
  Eigen::MatrixXf off = A;
  for (Index node = 0; node < 500; ++node)
    off.middleRows<3>(3 * Eigen::Index{node}) -= rows.transposed(node).transpose();
  const double worst = Eigen::BDCSVD<Eigen::MatrixXf>(off).singularValues()[0];
  EXPECT_LT(worst, tolerance);
  EXPECT_GT(worst, 0.1 * tolerance) << "room for a tolerance that was not asked for";
}

TEST(LowRankRows, nodes_that_are_read_together_are_as_right_as_the_others) {
  const auto points = points_in_a_box();
  const Eigen::MatrixXf A = smooth(points);
  std::vector<Index> every_fifth;
  for (Index node = 0; node < static_cast<Index>(kNodes); node += 5) every_fifth.push_back(node);
  const LowRankRows rows(points, A, 0.01, every_fifth);
  EXPECT_LT(largest_error(rows, A), 0.01);
  EXPECT_LT(static_cast<double>(rows.bytes()), 0.6 * static_cast<double>(bytes(A)));
}

TEST(LowRankRows, a_nodes_rows_are_those_that_are_multiplied_with) {
  const auto points = points_in_a_box();
  const LowRankRows rows(points, smooth(points), 0.01);
  auto product = rows.make_product();
  product.vector().setLinSpaced(-1.0F, 1.0F);
  for (Index node = 0; node < static_cast<Index>(kNodes); node += 17) {
    const Eigen::Vector3f expected = rows.transposed(node).transpose() * product.vector();
    EXPECT_LT((rows.times(node, product) - expected).norm(), 1e-4F * (1.0F + expected.norm()));
  }
}

TEST(LowRankRows, what_does_not_compress_stays_as_it_is) {
  const auto points = points_in_a_box();
  const Eigen::MatrixXf A = rough();
  for (const double tolerance : {0.0, 1e-3}) {
    const LowRankRows rows(points, A, tolerance);
    EXPECT_EQ(rows.bytes(), bytes(A));
    EXPECT_LT(largest_error(rows, A), 1e-5);
  }
}

TEST(LowRankRows, rows_that_are_zero_need_no_room) {
  const auto points = points_in_a_box();
  const Eigen::MatrixXf A = Eigen::MatrixXf::Zero(3 * static_cast<Eigen::Index>(kNodes), kColumns);
  const LowRankRows rows(points, A, 1e-3);
  EXPECT_EQ(rows.bytes(), 0U);
  EXPECT_EQ(largest_error(rows, A), 0.0);
}

TEST(LowRankRows, a_single_node_or_no_column_is_no_special_case) {
  const std::vector<Vec3> one{Vec3(1, 2, 3)};
  const Eigen::MatrixXf A = Eigen::MatrixXf::Constant(3, 2, 0.5F);
  const LowRankRows rows(one, A, 1e-3);
  auto product = rows.make_product();
  product.vector().setOnes();
  EXPECT_LT((rows.times(0, product) - Eigen::Vector3f::Ones()).norm(), 1e-3);
  const LowRankRows empty(one, Eigen::MatrixXf(3, 0), 1e-3);
  auto nothing = empty.make_product();
  EXPECT_EQ(empty.times(0, nothing).norm(), 0.0F);
}

TEST(LowRankRows, products_do_not_allocate) {
  if (!test::AllocationCount::available())
    GTEST_SKIP() << "under a sanitizer the memory functions cannot be replaced by counting ones";
  const auto points = points_in_a_box();
  const LowRankRows rows(points, smooth(points), 0.01);
  auto product = rows.make_product();
  const test::AllocationCount allocations;
  product.vector().setOnes();
  product.forget();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (Index node = 0; node < static_cast<Index>(kNodes); ++node) sum += rows.times(node, product);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_GT(sum.norm(), 0.0F);
}
