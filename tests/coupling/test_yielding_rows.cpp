// SPDX-License-Identifier: GPL-3.0-or-later
// The factorisation of the yielding rows against a dense solution.
#include "coupling/balance/yielding_rows.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

constexpr Eigen::Index kMostRows = 90;
constexpr Eigen::Index kMostSpringRows = 20;
constexpr Eigen::Index kMostColumns = 5;
constexpr double kRounding = 1e-11;

/// A random matrix of contacts' rows and springs' rows, as one dense matrix and as YieldingRows.
class Rows {
 public:
  Rows(Eigen::Index contacts, Eigen::Index springs)
      : yielding(kMostRows, kMostSpringRows, kMostColumns), contacts_(contacts), springs_(springs) {
    const Eigen::Index n = springs + kMostRows;
    const MatX root = random(n, n);
    R_ = root * root.transpose() / static_cast<double>(n) + MatX::Identity(n, n);
    R_.topLeftCorner(springs, springs) *= -1.0;
    F_ = MatX::Zero(kMostRows, springs);
    d_ = random(kMostRows, 1).cwiseAbs();
    yielding.begin(springs);
    for (Eigen::Index row = 0; row < contacts; ++row) yielding.add_row(d_[row]);
    for (Eigen::Index s = 0; s < springs; s += 2) {
      for (Eigen::Index row = 3 * s / 2; row < 3 * s / 2 + 3; ++row) {
        const Eigen::RowVector2d components = random(1, 2);
        F_.block<1, 2>(row, s) = components;
        yielding.add_direction(row, s, components);
      }
    }
  }

  bool factorise() { return yielding.factorise(R()); }
  void set_yield(Eigen::Index row, double yield) {
    d_[row] = yield;
    yielding.set_yield(row, yield);
  }
  void add_row() { yielding.add_row(d_[contacts_++]); }
  void keep_first(Eigen::Index rows) {
    contacts_ = rows;
    yielding.keep_first(rows);
  }

  /// Residual of the solution, over the right-hand side.
  double error() {
    MatX T = MatX::Zero(contacts_, springs_ + contacts_);
    T.leftCols(springs_) = F_.topRows(contacts_);
    T.rightCols(contacts_).setIdentity();
    const MatX M = R() + T.transpose() * d_.head(contacts_).asDiagonal() * T;
    const MatX b = random(M.rows(), 3);
    MatX x = b;
    yielding.solve(x);
    return (M * x - b).norm() / b.norm();
  }

  YieldingRows yielding;

 private:
  MatX random(Eigen::Index rows, Eigen::Index columns) {
    return MatX::NullaryExpr(rows, columns, [this] { return distribution_(random_); });
  }
  [[nodiscard]] MatX R() const { return R_.topLeftCorner(springs_ + contacts_, springs_ + contacts_); }

  std::mt19937 random_{11};
  std::uniform_real_distribution<double> distribution_{-1.0, 1.0};
  Eigen::Index contacts_;
  Eigen::Index springs_;
  MatX R_, F_;
  VecX d_;
};

TEST(YieldingRows, solve_with_and_without_springs) {
  for (const Eigen::Index springs : {0, 2, 8, 20}) {
    for (const Eigen::Index contacts : {30, 55, 90}) {
      Rows rows(contacts, springs);
      ASSERT_FALSE(rows.yielding.factorised());
      ASSERT_TRUE(rows.factorise());
      EXPECT_TRUE(rows.yielding.factorised());
      EXPECT_EQ(rows.yielding.rows(), contacts);
      EXPECT_EQ(rows.yielding.spring_rows(), springs);
      EXPECT_LT(rows.error(), kRounding) << contacts << ' ' << springs;
    }
  }
}

TEST(YieldingRows, take_in_another_yield_of_any_row) {
  for (const Eigen::Index springs : {0, 8}) {
    Rows rows(70, springs);
    ASSERT_TRUE(rows.factorise());
    for (const Eigen::Index row : {69, 30, 0, 48, 47, 69, 5}) {
      rows.set_yield(row, 2.0 + 0.1 * static_cast<double>(row));
      EXPECT_FALSE(rows.yielding.factorised());
      ASSERT_TRUE(rows.factorise()) << row;
      EXPECT_LT(rows.error(), kRounding) << row;
    }
  }
}

TEST(YieldingRows, a_factor_from_the_first_change_on_is_that_of_the_whole) {
  Rows changed(70, 8);
  ASSERT_TRUE(changed.factorise());
  Rows fresh(70, 8);
  for (Rows* rows : {&changed, &fresh}) rows->set_yield(60, 1.5);
  ASSERT_TRUE(changed.factorise());
  ASSERT_TRUE(fresh.factorise());
  MatX a = MatX::Ones(78, 2);
  MatX b = a;
  changed.yielding.solve(a);
  fresh.yielding.solve(b);
  EXPECT_EQ(a, b);
}

TEST(YieldingRows, take_in_rows_that_come_and_go) {
  Rows rows(60, 8);
  ASSERT_TRUE(rows.factorise());
  for (int k = 0; k < 3; ++k) rows.add_row();
  EXPECT_FALSE(rows.yielding.factorised());
  ASSERT_TRUE(rows.factorise());
  EXPECT_LT(rows.error(), kRounding);
  rows.keep_first(63);
  EXPECT_TRUE(rows.yielding.factorised());
  rows.keep_first(57);
  EXPECT_FALSE(rows.yielding.factorised());
  ASSERT_TRUE(rows.factorise());
  EXPECT_LT(rows.error(), kRounding);
}

TEST(YieldingRows, say_where_the_contacts_block_is_not_definite_and_recover) {
  Rows rows(60, 4);
  ASSERT_TRUE(rows.factorise());
  rows.set_yield(40, -50.0);
  EXPECT_FALSE(rows.factorise());
  EXPECT_FALSE(rows.yielding.factorised());
  rows.set_yield(40, 0.5);
  ASSERT_TRUE(rows.factorise());
  EXPECT_LT(rows.error(), kRounding);
}

}  // namespace
}  // namespace stylet
