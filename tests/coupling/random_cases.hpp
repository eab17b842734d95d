// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "support/sanitized.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

namespace stylet::test {

/// Number of cases for a test that draws them at random: STYLET_RANDOM_CASES where that is set.
inline int random_cases(int usual) {
  if (const char* given = std::getenv("STYLET_RANDOM_CASES")) return std::stoi(given);
  return kSanitized ? usual / 4 : usual;
}

/// The random numbers of one case, the same on every machine.
class Draw {
 public:
  explicit Draw(int seed) : bits_(static_cast<unsigned>(seed) + 1u) { bits_.discard(16); }

  double between(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(bits_()) / 4294967296.0; }
  bool one_in_two() { return between(0.0, 1.0) < 0.5; }
  /// A direction at most `most_deg` from another one, with the angle and the rotation about it uniformly distributed.
  Vec3 near(const Vec3& axis, double most_deg) {
    const double angle = between(0.0, most_deg) * std::numbers::pi / 180.0;
    const Vec3 side = across(axis);
    return std::cos(angle) * axis.normalized() + std::sin(angle) * side;
  }
  /// A unit vector perpendicular to another one.
  Vec3 across(const Vec3& axis) {
    const Vec3 helper = std::abs(axis.x()) < 0.8 * axis.norm() ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 first = axis.cross(helper).normalized();
    return Eigen::AngleAxisd(between(0.0, 2.0 * std::numbers::pi), axis.normalized()) * first;
  }

  /// A vector perpendicular to another one, of random length up to `most`.
  Vec3 aside(const Vec3& axis, double most) {
    const double length = between(0.0, most);
    return length * across(axis);
  }

 private:
  std::mt19937 bits_;
};

}  // namespace stylet::test
