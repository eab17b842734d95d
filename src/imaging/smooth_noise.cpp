// SPDX-License-Identifier: GPL-3.0-or-later
#include "smooth_noise.hpp"

#include <array>
#include <cmath>
#include <random>

namespace stylet {

SmoothNoise::SmoothNoise(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  table_.resize(static_cast<std::size_t>(kPoints) * kPoints * kPoints);
  // The mean of two uniform numbers; the standard library's normal distribution differs between systems.
  for (float& value : table_) {
    const double a = static_cast<double>(random() >> 11) * 0x1.0p-53;
    const double b = static_cast<double>(random() >> 11) * 0x1.0p-53;
    value = static_cast<float>(2.45 * (a + b - 1.0));
  }
}

double SmoothNoise::operator()(const Vec3& x) const {
  std::array<int, 3> low{}, high{};
  std::array<double, 3> t{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = x[static_cast<Eigen::Index>(axis)];
    const double whole = std::floor(at);
    const double part = at - whole;
    t[axis] = part * part * (3.0 - 2.0 * part);
    low[axis] = static_cast<int>(static_cast<long>(whole) & (kPoints - 1));
    high[axis] = (low[axis] + 1) & (kPoints - 1);
  }
  const auto value = [&](int i, int j, int k) {
    return static_cast<double>(table_[static_cast<std::size_t>((k * kPoints + j) * kPoints + i)]);
  };
  const auto row = [&](int j, int k) { return (1.0 - t[0]) * value(low[0], j, k) + t[0] * value(high[0], j, k); };
  const auto face = [&](int k) { return (1.0 - t[1]) * row(low[1], k) + t[1] * row(high[1], k); };
  return (1.0 - t[2]) * face(low[2]) + t[2] * face(high[2]);
}

}  // namespace stylet
