// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix of the shaft contacts, which is factorised once and then updated, against a dense solution.
#include "coupling/balance/grip_matrix.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

constexpr int kCapacity = 40;

/// Contacts of a needle in tissue, with the values that the matrix reads; mature contacts have no lateral D.
class Contacts {
 public:
  explicit Contacts(int grips) : grips_(grips), matrix_(kCapacity) {
    const Eigen::Index n = 3 * kCapacity;
    A_ = random_compliance(n, 1.0);
    N_ = random_compliance(n, 0.3);
    for (int g = 0; g < kCapacity; ++g) {
      const Vec3 along = Vec3(0.1 * number(), 0.1 * number(), 1.0).normalized();
      yields_.push_back({along, 0.0, 0.2 + std::abs(number())});
    }
  }

  std::vector<Yield>& yields() { return yields_; }
  [[nodiscard]] std::span<const Yield> present() const { return {yields_.data(), static_cast<std::size_t>(grips_)}; }

  bool factorise() { return matrix_.factorise(A(), N(), {}, present()) && matrix_.change(present()); }
  bool change() { return matrix_.change(present()); }
  bool append() {
    ++grips_;
    return matrix_.append(A(), N(), yields_[static_cast<std::size_t>(grips_ - 1)]) && change();
  }
  bool keep_first(int grips) {
    grips_ = grips;
    return matrix_.keep_first(grips) && change();
  }

  /// Residual of the matrix's solution, over the right-hand side.
  double error() {
    MatX P = A() + N();
    for (int g = 0; g < grips_; ++g) {
      const Yield& yield = yields_[static_cast<std::size_t>(g)];
      for (int k = 0; k < 3; ++k) P.block<3, 1>(3 * g, 3 * g + k) += yield.of(Vec3::Unit(k));
    }
    const MatX b = MatX::NullaryExpr(P.rows(), 3, [this] { return number(); });
    MatX x = b;
    matrix_.begin(x);
    matrix_.finish(x);
    return (P * x - b).norm() / b.norm();
  }

 private:
  double number() { return distribution_(random_); }
  MatX random_compliance(Eigen::Index n, double scale) {
    const MatX root = MatX::NullaryExpr(n, n, [this] { return number(); });
    return scale * (root * root.transpose() / static_cast<double>(n) + MatX::Identity(n, n));
  }
  [[nodiscard]] MatX A() const { return A_.topLeftCorner(3 * grips_, 3 * grips_); }
  [[nodiscard]] MatX N() const { return N_.topLeftCorner(3 * grips_, 3 * grips_); }

  std::mt19937 random_{7};
  std::uniform_real_distribution<double> distribution_{-1.0, 1.0};
  int grips_;
  MatX A_, N_;
  std::vector<Yield> yields_;
  GripMatrix matrix_;
};

constexpr double kRounding = 1e-11;

TEST(GripMatrix, takes_in_what_any_contact_yields) {
  Contacts contacts(34);
  ASSERT_TRUE(contacts.factorise());
  EXPECT_LT(contacts.error(), kRounding);
  // Near the tip, near the base, in the middle, and again near the tip.
  for (const std::size_t grip : {33, 32, 0, 17, 31, 25, 33, 2}) {
    contacts.yields()[grip].axial *= 3.0;
    if (grip > 30) contacts.yields()[grip].lateral += 0.1;
    ASSERT_TRUE(contacts.change()) << grip;
    EXPECT_LT(contacts.error(), kRounding) << grip;
  }
}

TEST(GripMatrix, takes_in_contacts_that_come_and_go) {
  Contacts contacts(30);
  ASSERT_TRUE(contacts.factorise());
  for (int k = 0; k < 4; ++k) {
    contacts.yields()[static_cast<std::size_t>(30 + k)].lateral = 0.5;
    ASSERT_TRUE(contacts.append()) << k;
    EXPECT_LT(contacts.error(), kRounding) << k;
    contacts.yields()[static_cast<std::size_t>(30 + k)].lateral = 0.05;
    ASSERT_TRUE(contacts.change()) << k;
    EXPECT_LT(contacts.error(), kRounding) << k;
  }
  ASSERT_TRUE(contacts.keep_first(32));
  EXPECT_LT(contacts.error(), kRounding);
  contacts.yields()[5].axial *= 0.1;
  ASSERT_TRUE(contacts.change());
  EXPECT_LT(contacts.error(), kRounding);
}

TEST(GripMatrix, is_right_again_after_what_it_could_not_take) {
  Contacts contacts(34);
  ASSERT_TRUE(contacts.factorise());
  contacts.yields()[1].axial *= 5.0;    // this change is possible without a new factorisation, …
  contacts.yields()[10].lateral = 0.4;  // … and this one is not: a settled row gets a D
  ASSERT_FALSE(contacts.change());
  contacts.yields()[10].lateral = 0.0;
  ASSERT_TRUE(contacts.change());
  EXPECT_LT(contacts.error(), kRounding);
  contacts.yields()[33].axial *= 2.0;
  ASSERT_TRUE(contacts.change());
  EXPECT_LT(contacts.error(), kRounding);
}

}  // namespace
}  // namespace stylet
