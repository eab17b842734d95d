// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// Smooth random function of space with mean 0, values between about −2 and 2, and details of the size 1.
class SmoothNoise {
 public:
  explicit SmoothNoise(std::uint64_t seed);
  [[nodiscard]] double operator()(const Vec3& x) const;

 private:
  static constexpr int kPoints = 32;
  std::vector<float> table_;
};

}  // namespace stylet
