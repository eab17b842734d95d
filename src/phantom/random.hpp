// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>

namespace stylet::phantom {

/// Random numbers that are the same on every machine. The standard specifies the sequence of the engine but not the
/// output of its distributions, so the mapping is written out here.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

  /// Triangular distribution around `centre`, within ± `reach`.
  double around(double centre, double reach) {
    const double a = uniform();
    const double b = uniform();
    return centre + reach * (a + b - 1.0);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace stylet::phantom
