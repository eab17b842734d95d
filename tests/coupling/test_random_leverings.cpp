// SPDX-License-Identifier: GPL-3.0-or-later
// Needles of 25 and 30 gauge bow under less force than breaks the skin. Pressed on the skin, and levered at random,
// they do not break it. STYLET_RANDOM_CASES=1000 build/bin/test_random_needles --gtest_filter=RandomLeverings.* tries a
// thousand cases.
#include "needle_in_block.hpp"
#include "random_cases.hpp"

#include <iostream>

namespace stylet::test {
namespace {

using Kind = EventKind;

constexpr double kSkin_N = 1.0;
constexpr double kRise_N = 0.05;  ///< largest rise of the force in a step

NeedleSection thin(double length_mm, double outer_mm, double inner_mm) {
  const double inertia = std::numbers::pi / 64.0 * (std::pow(outer_mm, 4) - std::pow(inner_mm, 4));
  return {length_mm, outer_mm, 200e3 * inertia, 2.0 * 77e3 * inertia};
}

/// A hand that presses the needle on the skin and moves to random poses, one after the other.
class Levering {
 public:
  Levering(NeedleInBlock& block, Draw& draw) : block_(block), draw_(draw) {
    const Vec3 through{draw.between(-15.0, 15.0), draw.between(-15.0, 15.0), 0.0};
    block.aim(through, draw.near(Vec3::UnitZ(), 30.0));
    from_ = to_ = {block.depth, Vec3::Zero(), Vec3::Zero()};
  }

  /// @return a description of what went wrong; empty if nothing did
  std::string run() {
    go({draw_.between(1.0, 8.0), Vec3::Zero(), Vec3::Zero()});
    for (int k = 0; k < 4 && !punctured_; ++k) {
      go({draw_.between(0.0, 25.0), draw_.aside(block_.axis, 30.0), draw_.aside(block_.axis, 0.6)});
    }
    return wrong_;
  }

 private:
  struct Hand {
    double depth = 0.0;
    Vec3 sideways = Vec3::Zero();
    Vec3 turn = Vec3::Zero();  ///< [rad]
  };

  void go(const Hand& to) {
    from_ = to_;
    to_ = to;
    const double way = std::abs(to.depth - from_.depth) + (to.sideways - from_.sideways).norm() +
                       block_.length * (to.turn - from_.turn).norm();
    const double speed = draw_.between(20.0, 200.0);
    const double dt = 1e-3;
    const auto steps = std::max<long>(1, std::lround(way / (speed * dt)));
    for (long k = 1; k <= steps && !punctured_; ++k) step(static_cast<double>(k) / static_cast<double>(steps), dt);
  }

  void step(double share, double dt) {
    const double depth = from_.depth + share * (to_.depth - from_.depth);
    const Vec3 turn = from_.turn + share * (to_.turn - from_.turn);
    Pose pose{
        block_.point + from_.sideways + share * (to_.sideways - from_.sideways) + (depth - block_.length) * block_.axis,
        Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), block_.axis)};
    if (turn.norm() > 0.0)
      pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * pose.rotation;
    block_.insertion->prepare(8.0);
    const double before = block_.report.hand_force_N.norm();
    block_.report = block_.insertion->step(pose, dt);
    for (const InsertionEvent& event : block_.insertion->events()) {
      if (event.kind != Kind::puncture) continue;
      punctured_ = true;
      // Only the tip holds the needle, so the hand's force is the tip's.
      if (before < kSkin_N - kRise_N || event.force_N < 0.5 * kSkin_N)
        wrong_ = "punctured at " + std::to_string(event.force_N) + " N along the hand's axis, the step before with " +
                 std::to_string(before) + " N";
    }
  }

  NeedleInBlock& block_;
  Draw& draw_;
  Hand from_, to_;
  std::string wrong_;
  bool punctured_ = false;
};

TEST(RandomLeverings, skin_breaks_under_no_less_than_it_bears) {
  const int cases = random_cases(24);
  int wrong = 0;
  for (int k = 0; k < cases; ++k) {
    Draw draw(k);
    BlockOptions options;
    options.cells = {5, 5, 5};
    options.laws[0].puncture_N = kSkin_N;
    options.needle_length = draw.between(100.0, 200.0);
    options.needle = [&](int capacity) {
      const NeedleSection section =
          k % 2 == 0 ? thin(options.needle_length, 0.515, 0.26) : thin(options.needle_length, 0.312, 0.159);
      return BeamNeedle::build(section, 20, capacity).value();
    };
    NeedleInBlock block(options);
    Levering levering(block, draw);
    const std::string what = levering.run();
    if (what.empty()) continue;
    if (++wrong <= 10) std::cout << "case " << k << ": " << what << "\n";
  }
  std::cout << wrong << " of " << cases << " needles broke skin that bears more\n";
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace stylet::test
