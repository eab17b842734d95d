// SPDX-License-Identifier: GPL-3.0-or-later
// The linear equations of one iteration against the same equations assembled as one matrix.
#include "coupling/balance/contact_system.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace stylet {
namespace {

using TipRows = ContactSystem::TipRows;

/// The contacts at which springs are lent to the needle.
enum class Springs { none, at_grips, everywhere };

struct Case {
  Springs springs = Springs::none;
  int at_rest = 0;  ///< most contacts of another needle that rests, which come after the tip
};

/// Contacts along a curved needle, in a medium whose compliance decreases with distance.
struct Equations {
  /// @param contacts of all needles, the tip included
  Equations(int contacts, Case of)
      : at_rest(std::min(of.at_rest, contacts - 1)), rows(settings, contacts), system(rows, contacts, at_rest) {
    const Springs springs = of.springs;
    const bool lend_springs = springs != Springs::none;
    system.needle.count = contacts;
    const Eigen::Index n = 3 * static_cast<Eigen::Index>(contacts);
    for (int c = 0; c < contacts; ++c) {
      for (int d = 0; d < contacts; ++d) {
        const Vec3 r = (c - d) * Vec3(0.1, 0.05, 3.0);
        const double fall = 2.0 / (1.0 + r.norm());
        system.A.block<3, 3>(3 * c, 3 * d) = fall * (Mat3::Identity() + r * r.transpose() / (1.0 + r.squaredNorm()));
        if (rests(c) != rests(d)) continue;
        const double lever = std::min(c + 1, d + 1);
        system.needle.N.block<3, 3>(3 * c, 3 * d) =
            0.05 * lever * lever * (3.0 * std::max(c + 1, d + 1) - lever) * Vec3(1.0, 1.0, 1e-3).asDiagonal();
      }
      const double angle = 0.02 * c;
      rows.frame[static_cast<std::size_t>(c)] = Eigen::AngleAxisd(angle, Vec3(0.6, 0.8, 0.0)).toRotationMatrix();
      Yield& yield = rows.yield[static_cast<std::size_t>(c)];
      const double softness = c % 4 == 1 ? 0.1 : 0.0;
      yield = {rows.frame[static_cast<std::size_t>(c)].col(2), softness, c % 3 == 0 ? 4.0 : softness};
      // The spring is some steps old, so its direction differs a little from the contact's present direction.
      if (lend_springs && (c > 0 || contacts == 1) && c % 5 != 2)
        system.needle.spring[static_cast<std::size_t>(c)] = {(yield.along + Vec3(0.01, -0.02, 0.0)).normalized(), 0.4};
      if (c == 0 && springs == Springs::everywhere) system.needle.spring.front() = {Vec3::Zero(), 0.7};
      for (int k = 0; k < 3; ++k) {
        const Eigen::Index i = 3 * c + k;
        rows.now[i] = 0.1 * std::sin(1.0 + 2.0 * static_cast<double>(i));
        rows.gap[i] = 0.2 * std::cos(3.0 * static_cast<double>(i));
        system.needle.free[i] = 0.1 * std::sin(0.7 * static_cast<double>(i));
        rows.shift[i] = 0.05 * std::cos(static_cast<double>(i));
        rows.tip.drift[i] = 0.1 * std::sin(0.3 + static_cast<double>(i));
      }
    }
    system.needle.supported = lend_springs;
    size = n;
  }

  [[nodiscard]] bool rests(int contact) const { return contact > 0 && contact <= at_rest; }

  /// The expected result of solve(): λ in the frames and p, from all equations in one system.
  [[nodiscard]] std::pair<VecX, VecX> whole(TipRows held) const {
    MatX Q = MatX::Zero(size, size);
    MatX D = MatX::Zero(size, size);
    MatX G = MatX::Zero(size, size);
    for (int c = 0; c < system.needle.count; ++c) {
      const auto i = static_cast<std::size_t>(c);
      Q.block<3, 3>(3 * c, 3 * c) = rows.frame[i];
      for (int k = 0; k < 3; ++k) D.col(3 * c + k).segment<3>(3 * c) = rows.yield[i].of(Vec3::Unit(k));
      G.block<3, 3>(3 * c, 3 * c) = system.needle.spring[i].matrix();
    }
    const MatX A = system.A.topLeftCorner(size, size);
    const MatX N = system.needle.N.topLeftCorner(size, size);
    const VecX now = rows.now.head(size);
    // Unknowns λ and p: λ − p − G (free − N (p − now)) = 0, and in the frames either the row or λ = 0.
    MatX left = MatX::Zero(2 * size, 2 * size);
    VecX right = VecX::Zero(2 * size);
    left.topLeftCorner(size, size).setIdentity();
    left.topRightCorner(size, size) = -MatX::Identity(size, size) + G * N;
    right.head(size) = G * (system.needle.free.head(size) + N * now);
    left.bottomLeftCorner(size, size) = Q.transpose() * (A + D);
    left.bottomRightCorner(size, size) = Q.transpose() * N;
    right.tail(size) = Q.transpose() * (A * now + N * now + system.needle.free.head(size) - rows.gap.head(size)) +
                       rows.shift.head(size);
    // The gaps change with the cut, whose length depends on the tip's axial force.
    const VecX drift = Q.transpose() * rows.tip.drift.head(size);
    const Vec3 t = rows.frame[0].col(2);
    left.bottomLeftCorner(size, 3) += rows.tip.cut_per_N * drift * t.transpose();
    right.tail(size) -=
        (rows.tip.cut_per_N > 0.0 ? rows.tip.cut_due - rows.tip.cut_per_N * t.dot(now.head<3>()) : 0.0) * drift;
    // Direction of a tip that is held along the needle only: t + w, where w is (r − r_now) of the tip minus that of the
    // contact behind it, over the distance between them.
    const bool turns = held == TipRows::axial && rows.tip.behind > 0;
    MatX w_of_p = MatX::Zero(3, size);
    Vec3 w = Vec3::Zero();
    if (turns) {
      const Eigen::Index g = 3 * static_cast<Eigen::Index>(rows.tip.behind);
      w_of_p = -(N.topRows<3>() - N.middleRows<3>(g)) / rows.tip.behind_mm;
      w = (system.needle.free.head<3>() - system.needle.free.segment<3>(g)) / rows.tip.behind_mm - w_of_p * now;
    }
    for (int k = 0; k < 3; ++k) {
      const bool is_held = held == TipRows::all || (held == TipRows::axial && k == 2);
      if (is_held) {  // a part of the present lateral gap lies along t + w
        const Vec3 aside = rows.error(0)[0] * Q.block<3, 1>(0, 0) + rows.error(0)[1] * Q.block<3, 1>(0, 1);
        if (turns) {
          left.row(size + k).tail(size) += aside.transpose() * w_of_p;
          right[size + k] -= aside.dot(w);
        }
        continue;
      }
      // n·λ = 0 with n turning like t: n·λ = (n·w) (t·λ_now).
      const Vec3 across = Q.block<3, 1>(0, k);
      const double pressed = t.dot(now.head<3>());
      left.row(size + k).setZero();
      left.row(size + k).head<3>() = across.transpose();
      left.row(size + k).tail(size) -= pressed * across.transpose() * w_of_p;
      right[size + k] = pressed * across.dot(w);
    }
    const VecX solution = left.partialPivLu().solve(right);
    return {Q.transpose() * solution.head(size), solution.tail(size)};
  }

  void expect_solved(TipRows held, const char* what) {
    ASSERT_TRUE(system.solve(held)) << what;
    const auto [lambda, push] = whole(held);
    EXPECT_LT((system.lambda.head(size) - lambda).norm(), 1e-9 * lambda.norm() + 1e-14) << what;
    EXPECT_LT((system.push.head(size) - push).norm(), 1e-9 * push.norm() + 1e-14) << what;
  }

  CouplingSettings settings;
  int at_rest;
  ContactRows rows;
  ContactSystem system;
  Eigen::Index size;
};

class ContactEquations : public testing::TestWithParam<Case> {};

TEST_P(ContactEquations, are_solved_whatever_of_the_tip_is_held) {
  for (const int contacts : {1, 2, 9, 31}) {
    Equations equations(contacts, GetParam());
    ASSERT_TRUE(equations.system.factorise());
    equations.system.add_tip();
    for (const TipRows held : {TipRows::all, TipRows::axial, TipRows::none})
      equations.expect_solved(held, std::to_string(contacts).c_str());
  }
}

TEST_P(ContactEquations, are_solved_while_compliance_changes_with_the_cut) {
  for (const int contacts : {1, 2, 9, 31}) {
    Equations equations(contacts, GetParam());
    equations.rows.tip.cut_per_N = 0.7;
    equations.rows.tip.cut_due = 0.3;
    ASSERT_TRUE(equations.system.factorise());
    for (const TipRows held : {TipRows::all, TipRows::axial})
      equations.expect_solved(held, std::to_string(contacts).c_str());
  }
}

TEST_P(ContactEquations, are_solved_while_the_tip_turns_with_the_needle) {
  for (const int contacts : {2, 9, 31}) {
    if (contacts - 1 <= GetParam().at_rest) continue;  // there is no contact behind the tip
    for (const bool cuts : {false, true}) {
      Equations equations(contacts, GetParam());
      ContactSystem& system = equations.system;
      ContactRows& rows = equations.rows;
      rows.now.head<3>() = 8.0 * rows.frame[0].col(2);
      rows.tip.behind = contacts - 1;
      rows.tip.behind_mm = 3.0;
      rows.tip.cut_per_N = cuts ? 0.7 : 0.0;
      rows.tip.cut_due = cuts ? 0.3 : 0.0;
      ASSERT_TRUE(system.factorise());
      for (const TipRows held : {TipRows::axial, TipRows::all, TipRows::none})
        equations.expect_solved(held, std::to_string(contacts).c_str());
    }
  }
}

TEST_P(ContactEquations, are_solved_with_a_tangent_that_was_prepared_when_there_were_fewer_contacts) {
  for (const int own : {1, 2, 9}) {
    const int fewer = GetParam().at_rest + own;
    Equations equations(GetParam().at_rest + 12, GetParam());
    ContactSystem& system = equations.system;
    ContactRows& rows = equations.rows;
    ASSERT_TRUE(system.factorise());
    system.prepared.count = fewer;
    system.prepared.N = 1.3 * system.needle.N;
    system.prepared.spring = system.needle.spring;
    for (LentSpring& spring : system.prepared.spring) spring.stiffness *= 0.8;
    if (const Eigen::Index n = 3 * static_cast<Eigen::Index>(equations.at_rest); n > 0) {  // those stay as they are
      system.prepared.N.block(3, 3, n, n) = system.needle.N.block(3, 3, n, n);
      std::copy_n(system.needle.spring.begin() + 1, equations.at_rest, system.prepared.spring.begin() + 1);
    }
    system.prepared.supported = GetParam().springs != Springs::none;
    system.fill_prepared();
    ASSERT_TRUE(system.factorise_prepared());
    equations.expect_solved(TipRows::all, "beside it, the one in use");
    system.take_prepared();
    equations.size = 3 * fewer;
    equations.expect_solved(TipRows::all, "the one that was prepared");
    rows.yield[static_cast<std::size_t>(fewer * 2 / 3)].axial = 5.0;
    equations.expect_solved(TipRows::axial, "a contact slides");
  }
}

TEST_P(ContactEquations, are_solved_with_contacts_that_slide_or_hold_since_the_matrix_was_made) {
  Equations equations(20, GetParam());
  ASSERT_TRUE(equations.system.factorise());
  equations.system.add_tip();
  auto& yield = equations.rows.yield;
  yield[3].axial = 0.1;
  equations.expect_solved(TipRows::all, "one holds");
  yield[4].axial = 7.0;
  yield[5].axial = 3e5;
  equations.expect_solved(TipRows::axial, "two slide, one of them freely");
  yield[3].axial = 4.0;
  yield[5].axial = 0.1;
  equations.expect_solved(TipRows::all, "two are as they were");
  yield[19].lateral = 50.0;
  yield[19].axial = 60.0;
  equations.expect_solved(TipRows::all, "the youngest yields in all directions");
  for (std::size_t c = 1; c < 20; ++c) yield[c].axial = 2.0;
  equations.expect_solved(TipRows::none, "all change");
  yield[4].lateral = 0.7;
  equations.expect_solved(TipRows::all, "one of those in the middle grows soft");
  yield[7] = {Vec3(0.3, 0.2, 0.9).normalized(), 0.0, 5e4};
  equations.expect_solved(TipRows::all, "one slides freely, another way than it was");
}

TEST_P(ContactEquations, are_solved_when_the_tip_has_moved_on_and_the_last_contacts_are_gone) {
  Equations equations(12, GetParam());
  ContactSystem& system = equations.system;
  ContactRows& rows = equations.rows;
  ASSERT_TRUE(system.factorise());
  const Mat3 more = 0.3 * Mat3::Identity();
  if (GetParam().springs == Springs::none) {
    rows.yield[6].axial = 5.0;
    ASSERT_TRUE(system.solve(TipRows::all));
  }
  const bool last_has_a_spring = GetParam().springs != Springs::none;
  EXPECT_EQ(system.keep_first(9), !last_has_a_spring);
  if (last_has_a_spring) {
    ASSERT_TRUE(system.factorise());
  }
  equations.size = 27;
  system.A.topLeftCorner<3, 3>() += more;
  system.add_tip();
  equations.expect_solved(TipRows::all, "nine of twelve, a softer tip");
  const int few = GetParam().at_rest > 0 ? 8 : 4;
  EXPECT_FALSE(system.keep_first(few)) << "size of older ones stay";
  ASSERT_TRUE(system.factorise());
  equations.size = 3 * few;
  equations.expect_solved(TipRows::all, "a few of twelve");
}

TEST_P(ContactEquations, are_solved_with_contacts_that_came_alive_since_the_matrix_was_made) {
  for (const int own : {1, 2, 12}) {
    const int before = GetParam().at_rest + own;
    Equations equations(before + 3, GetParam());
    ContactSystem& system = equations.system;
    ContactRows& rows = equations.rows;
    for (int c = before; c < before + 3; ++c) system.needle.spring[static_cast<std::size_t>(c)] = {};
    system.needle.count = before;
    ASSERT_TRUE(system.factorise());
    for (int c = before; c < before + 3; ++c) {
      system.needle.count = c + 1;
      rows.yield.back().lateral = 1e4;  // the youngest contact
      ASSERT_TRUE(system.append()) << before;
      system.add_tip();
      equations.size = 3 * system.needle.count;
      equations.expect_solved(TipRows::all, "as they come");
    }
    rows.yield.back().lateral = 2.0;
    rows.yield[static_cast<std::size_t>(before)].axial = 9.0;
    equations.expect_solved(TipRows::axial, "one older, one slides");
    ASSERT_TRUE(system.keep_first(before + 2)) << before;
    equations.size = 3 * system.needle.count;
    equations.expect_solved(TipRows::all, "the youngest is gone");
  }
}

TEST_P(ContactEquations, are_put_in_order_again_when_many_contacts_have_come_alive) {
  const int first = GetParam().at_rest + 5;
  Equations equations(first + 25, GetParam());
  ContactSystem& system = equations.system;
  for (int c = first; c < first + 25; ++c) system.needle.spring[static_cast<std::size_t>(c)] = {};
  system.needle.count = first;
  ASSERT_TRUE(system.factorise());
  int anew = 0;
  for (int c = first; c < first + 25; ++c) {
    system.needle.count = c + 1;
    if (!system.append()) {
      ++anew;
      ASSERT_TRUE(system.factorise());
    }
    equations.size = 3 * system.needle.count;
    equations.expect_solved(TipRows::all, std::to_string(c).c_str());
  }
  EXPECT_GE(anew, 1);
  EXPECT_LE(anew, 5);
}

TEST_P(ContactEquations, tell_how_far_the_needle_is_beyond_the_tissue_where_the_tip_is_free) {
  Equations equations(7, GetParam());
  ContactSystem& system = equations.system;
  ContactRows& rows = equations.rows;
  ASSERT_TRUE(system.factorise());
  system.add_tip();
  ASSERT_TRUE(system.solve(TipRows::none));
  const auto [lambda, push] = equations.whole(TipRows::none);
  VecX force(equations.size);
  for (int c = 0; c < 7; ++c)
    force.segment<3>(3 * c) = rows.frame[static_cast<std::size_t>(c)] * lambda.segment<3>(3 * c);
  const VecX now = rows.now.head(equations.size);
  const auto n = equations.size;
  const VecX way = system.needle.free.head(n) - system.needle.N.topLeftCorner(n, n) * (push - now) - rows.gap.head(n) -
                   system.A.topLeftCorner(n, n) * (force - now);
  EXPECT_NEAR(system.opening(), rows.frame[0].col(2).dot(way.head<3>()), 1e-10);
}

/// A needle at rest on lent springs stays bent out of balance where their small forces are left out.
TEST_P(ContactEquations, are_solved_for_small_errors_at_rest_where_that_is_asked_for) {
  Equations equations(20, GetParam());
  ContactSystem& system = equations.system;
  ContactRows& rows = equations.rows;
  equations.settings.tolerance = 0.1;
  for (int c = 1; c <= equations.at_rest; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const Vec3 error(1e-4 * c, -2e-4, 1e-4);
    rows.gap.segment<3>(3 * c) =
        rows.frame[i] * (error + rows.shift.segment<3>(3 * c)) - rows.yield[i].of(rows.now.segment<3>(3 * c));
    system.needle.free.segment<3>(3 * c) *= 1e-3;
  }
  ASSERT_TRUE(system.factorise());
  system.add_tip();
  system.solve_all_at_rest(false);
  ASSERT_TRUE(system.solve(TipRows::all));
  const VecX without = system.lambda.head(equations.size);
  system.solve_all_at_rest(true);
  equations.expect_solved(TipRows::all, "all errors");
  EXPECT_EQ((system.lambda.head(equations.size) - without).norm() > 1e-6, equations.at_rest > 0);
}

INSTANTIATE_TEST_SUITE_P(Needle, ContactEquations,
                         testing::Values(Case{Springs::none}, Case{Springs::at_grips}, Case{Springs::everywhere},
                                         Case{Springs::none, 6}, Case{Springs::at_grips, 6},
                                         Case{Springs::everywhere, 6}),
                         [](const auto& tested) -> std::string {
                           const std::string beside = tested.param.at_rest > 0 ? "_beside_one_at_rest" : "";
                           switch (tested.param.springs) {
                             case Springs::none:
                               return "by_itself" + beside;
                             case Springs::at_grips:
                               return "on_springs" + beside;
                             default:
                               return "on_springs_and_one_at_its_tip" + beside;
                           }
                         });

}  // namespace
}  // namespace stylet
