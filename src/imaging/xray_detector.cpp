// SPDX-License-Identifier: GPL-3.0-or-later
#include "xray_detector.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// The normal distribution's quantile, by bisection of its distribution function; used while tables are made.
double normal_quantile(double share) {
  double low = -9.0;
  double high = 9.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Scrambles a number (the finaliser of SplitMix64: Steele, Lea and Flood 2014, doi:10.1145/2660193.2660195).
std::uint64_t scrambled(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

constexpr float kLeastSignal = 1e-6F;  ///< stands for a pixel without a photon

}  // namespace

XrayDetector::XrayDetector(const FluoroscopySettings& settings)
    : pixels_(settings.pixels), photons_(settings.photons), random_(static_cast<std::uint64_t>(settings.random)) {
  double square = 0.0;
  for (std::size_t k = 0; k < kQuantiles; ++k) {
    normal_[k] = static_cast<float>(normal_quantile((static_cast<double>(k) + 0.5) / kQuantiles));
    square += normal_[k] * normal_[k];
  }
  const auto to_unit_variance = static_cast<float>(1.0 / std::sqrt(square / kQuantiles));
  for (float& value : normal_) value *= to_unit_variance;
  const auto count = static_cast<std::size_t>(pixels_) * static_cast<std::size_t>(pixels_);
  signal_.resize(count);
  depth_.resize(count);
}

/// Photons are distributed by Poisson. The square root of such a number plus 3/8 is nearly normal with a standard
/// deviation of 1/2 (Anscombe 1948, Biometrika 35:246).
void XrayDetector::count_photons(std::span<const float> transmission, std::uint64_t exposure) {
  if (photons_ <= 0.0) {
    std::copy(transmission.begin(), transmission.end(), signal_.begin());
    return;
  }
  constexpr float kAnscombe = 0.375F;
  constexpr int kBits = 12;
  static_assert(kQuantiles == 1U << kBits);
  constexpr std::size_t kPixelsPerNumber = 64 / kBits;
  const auto photons = static_cast<float>(photons_);
  const float per_photon = 1.0F / photons;
  const std::uint64_t stream = scrambled(exposure ^ scrambled(random_ + 1));
  for (std::size_t k = 0; k < transmission.size(); k += kPixelsPerNumber) {
    std::uint64_t bits = scrambled(stream + k * 0x9E3779B97F4A7C15U);
    const std::size_t end = std::min(transmission.size(), k + kPixelsPerNumber);
    for (std::size_t i = k; i < end; ++i) {
      const float normal = normal_[bits & (kQuantiles - 1)];
      bits >>= kBits;
      const float root = std::max(0.0F, std::sqrt(photons * transmission[i] + kAnscombe) + 0.5F * normal);
      signal_[i] = per_photon * std::max(0.0F, root * root - kAnscombe);
    }
  }
}

/// Spreads part of the signal over the neighbouring pixels: rows, then columns. Uses depth_ for the rows.
void XrayDetector::blur() {
  constexpr float kSide = 0.15F;
  constexpr float kCentre = 1.0F - 2.0F * kSide;
  const auto n = static_cast<std::size_t>(pixels_);
  for (std::size_t row = 0; row < n; ++row) {
    const float* from = &signal_[row * n];
    float* to = &depth_[row * n];
    to[0] = (1.0F - kSide) * from[0] + kSide * from[1];
    for (std::size_t k = 1; k + 1 < n; ++k) to[k] = kSide * (from[k - 1] + from[k + 1]) + kCentre * from[k];
    to[n - 1] = (1.0F - kSide) * from[n - 1] + kSide * from[n - 2];
  }
  for (std::size_t row = 0; row < n; ++row) {
    const float* above = &depth_[(row > 0 ? row - 1 : row) * n];
    const float* here = &depth_[row * n];
    const float* below = &depth_[(row + 1 < n ? row + 1 : row) * n];
    float* to = &signal_[row * n];
    for (std::size_t k = 0; k < n; ++k) to[k] = kSide * (above[k] + below[k]) + kCentre * here[k];
  }
}

void XrayDetector::detect(std::span<const float> transmission, std::uint64_t exposure) {
  count_photons(transmission, exposure);
  blur();
  const auto count = static_cast<Eigen::Index>(signal_.size());
  Eigen::Map<Eigen::ArrayXf>(depth_.data(), count) =
      -Eigen::Map<const Eigen::ArrayXf>(signal_.data(), count).max(kLeastSignal).log();
}

void XrayDetector::shade(int pixels, std::span<const float> depths, std::span<std::uint8_t> shades) {
  constexpr float kDeepest = 14.0F;
  constexpr float kPatient = 0.25F;  // less than this much optical depth is air
  constexpr std::size_t kBins = 1024;
  constexpr double kBright = 0.03;
  constexpr double kDark = 0.99;
  constexpr float kNarrowest = 0.5F;    // a narrower window would show noise and nothing else
  constexpr double kFieldRadius = 0.4;  // of the picture's width
  std::array<int, kBins> counts{};
  constexpr float kBinsPerDepth = kBins / kDeepest;
  int total = 0;
  const double middle = 0.5 * (pixels - 1);
  for (int row = 0; row < pixels; ++row) {
    const double off = (row - middle) / pixels;
    const double half = pixels * std::sqrt(std::max(0.0, kFieldRadius * kFieldRadius - off * off));
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels);
    const auto begin = first + static_cast<std::size_t>(std::max(0.0, std::ceil(middle - half)));
    const auto end = first + static_cast<std::size_t>(std::max(0.0, std::floor(middle + half)));
    for (std::size_t k = begin; k < end; ++k) {
      if (depths[k] <= kPatient) continue;
      ++counts[std::min(kBins - 1, static_cast<std::size_t>(depths[k] * kBinsPerDepth))];
      ++total;
    }
  }
  const auto quantile = [&](double share) {
    int below = 0;
    for (std::size_t k = 0; k < kBins; ++k) {
      below += counts[k];
      if (below > share * total) return (static_cast<float>(k) + 0.5F) / kBinsPerDepth;
    }
    return kDeepest;
  };
  const float bright = total > 0 ? quantile(kBright) : 0.0F;
  const float dark = total > 0 ? std::max(quantile(kDark), bright + kNarrowest) : 1.0F;
  constexpr float kWhite = 255.0F;
  constexpr float kHalf = 0.5F;  // rounds to the nearest
  const float per_depth = kWhite / (dark - bright);
  for (std::size_t k = 0; k < depths.size(); ++k)
    shades[k] = static_cast<std::uint8_t>(std::clamp((dark - depths[k]) * per_depth + kHalf, kHalf, kWhite + kHalf));
}

}  // namespace stylet
