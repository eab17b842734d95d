// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/swelling.hpp"

#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr int kParts = 16;

}  // namespace

Vec3 Swelling::factors(double days) const { return Vec3::Ones() + std::exp2(-days / half_life_days) * at_start; }

/// Within a part from a to b, where the sources' activity is exp(−λt), the mean of exp(−μt) is
///   λ / (λ + μ) · (e^(−(λ+μ)a) − e^(−(λ+μ)b)) / (e^(−λa) − e^(−λb)),
/// with e^(−λa) and e^(−λb) equal steps from 1 down to e^(−λ days).
std::vector<SwollenTime> swollen_times(const Swelling& swelling, double half_life_days, double days) {
  if (!swelling.is_any()) return {SwollenTime{}};
  const double lambda = std::numbers::ln2 / half_life_days;
  const double mu = std::numbers::ln2 / swelling.half_life_days;
  const double last = std::exp(-lambda * days);
  const double power = (lambda + mu) / lambda;
  std::vector<SwollenTime> times;
  for (int k = 0; k < kParts; ++k) {
    const double from = 1.0 - (1.0 - last) * k / kParts;
    const double to = 1.0 - (1.0 - last) * (k + 1) / kParts;
    const double mean = (std::pow(from, power) - std::pow(to, power)) / (power * (from - to));
    times.push_back({1.0 / kParts, Vec3::Ones() + mean * swelling.at_start});
  }
  return times;
}

}  // namespace stylet
