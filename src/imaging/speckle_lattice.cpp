// SPDX-License-Identifier: GPL-3.0-or-later
#include "speckle_lattice.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace stylet {

namespace {

/// A well mixed 64-bit number of a counter (SplitMix64, Steele, Lea & Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

double unit(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1.0p-53; }

}  // namespace

SpeckleLattice::SpeckleLattice(std::uint32_t seed) {
  axes_ = (Eigen::AngleAxisd(0.61, Vec3::UnitX()) * Eigen::AngleAxisd(0.83, Vec3::UnitY()) *
           Eigen::AngleAxisd(0.37, Vec3::UnitZ()))
              .toRotationMatrix();
  table_.resize(static_cast<std::size_t>(kPoints) * kPoints * kRow);
  std::uint64_t counter = static_cast<std::uint64_t>(seed) << 32;
  for (std::size_t row = 0; row < static_cast<std::size_t>(kPoints) * kPoints; ++row) {
    float* const at = &table_[row * kRow];
    for (int k = 0; k < kPoints; ++k) {
      // Box & Muller 1958: a complex number with Gaussian parts whose mean power is 1.
      const double size = std::sqrt(-std::log(unit(mixed(counter++))));
      const double phase = 2.0 * std::numbers::pi * unit(mixed(counter++));
      at[2 * k] = static_cast<float>(size * std::cos(phase));
      at[2 * k + 1] = static_cast<float>(size * std::sin(phase));
    }
    at[2 * kPoints] = at[0];
    at[2 * kPoints + 1] = at[1];
  }
}

std::complex<float> SpeckleLattice::at(const Eigen::Vector3f& position) const {
  const Eigen::Vector3i whole = position.cast<int>();  // positions are positive
  const Eigen::Vector3f t = position - whole.cast<float>();
  constexpr int kMask = kPoints - 1;
  const int x = 2 * (whole.x() & kMask);
  const int y0 = whole.y() & kMask, y1 = (y0 + 1) & kMask;
  const int z0 = whole.z() & kMask, z1 = (z0 + 1) & kMask;
  const auto pair = [&](int y, int z) {
    return Eigen::Map<const Eigen::Array4f>(&table_[static_cast<std::size_t>((z * kPoints + y) * kRow + x)]);
  };
  const float uy = 1.0F - t.y(), uz = 1.0F - t.z(), ux = 1.0F - t.x();
  const Eigen::Array4f sum = (uy * uz) * pair(y0, z0) + (t.y() * uz) * pair(y1, z0) + (uy * t.z()) * pair(y0, z1) +
                             (t.y() * t.z()) * pair(y1, z1);
  const float power = (ux * ux + t.x() * t.x()) * (uy * uy + t.y() * t.y()) * (uz * uz + t.z() * t.z());
  const float scale = 1.0F / std::sqrt(power);
  return {scale * (ux * sum[0] + t.x() * sum[2]), scale * (ux * sum[1] + t.x() * sum[3])};
}

double SpeckleLattice::correlation(double distance_mm) {
  // The autocorrelation of linear interpolation is the cubic B-spline.
  const double d = std::abs(distance_mm) / kSpacing_mm;
  if (d >= 2.0) return 0.0;
  if (d >= 1.0) return 0.25 * (2.0 - d) * (2.0 - d) * (2.0 - d);
  return 1.0 - 1.5 * d * d + 0.75 * d * d * d;
}

}  // namespace stylet
