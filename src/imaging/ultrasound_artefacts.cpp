// SPDX-License-Identifier: GPL-3.0-or-later
#include "ultrasound_artefacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace stylet {

namespace {

constexpr float kSideLobes = 0.022F;      // −33 dB of the mean amplitude at the same depth
constexpr float kReverberation = 0.070F;  // −23 dB of what came from less deep, see kMemory_mm
constexpr double kMemory_mm = 6.0;
constexpr double kNoise_dB = -54.0;        // of the receiver near the probe
constexpr double kNoise_dB_per_mm = 0.16;  // its growth by the gain with depth
constexpr double kRing_mm = 0.62;          // distance of the rings near the transducer
constexpr double kRings_mm = 0.7;          // depth over which they fall to 1/e

}  // namespace

UltrasoundArtefacts::UltrasoundArtefacts(int lines, int samples, std::uint32_t seed)
    : lines_(lines),
      samples_(samples),
      pattern_(2 * static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples)),
      rows_(pattern_.size()),
      memory_(static_cast<std::size_t>(lines)),
      amplitude_(static_cast<std::size_t>(lines) + 1) {
  std::mt19937 random(seed + 77);
  const auto n = static_cast<std::size_t>(samples);
  for (int line = 0; line < lines; ++line) {
    // White noise, blurred over three samples; its mean power is 1.
    float* const at = &pattern_[2 * static_cast<std::size_t>(line) * n];
    double before_real = 0.0, before_imaginary = 0.0;
    for (std::size_t s = 0; s < n; ++s) {
      const double size = std::sqrt(-std::log((static_cast<double>(random()) + 0.5) * 0x1.0p-32));
      const double phase = 2.0 * std::numbers::pi * static_cast<double>(random()) * 0x1.0p-32;
      before_real = 0.6 * before_real + 0.8 * size * std::cos(phase);
      before_imaginary = 0.6 * before_imaginary + 0.8 * size * std::sin(phase);
      at[2 * s] = static_cast<float>(before_real);
      at[2 * s + 1] = static_cast<float>(before_imaginary);
    }
  }
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t line = 0; line < static_cast<std::size_t>(lines); ++line) {
      const std::size_t row = 2 * s * static_cast<std::size_t>(lines);
      rows_[row + line] = pattern_[2 * (line * n + s)];
      rows_[row + static_cast<std::size_t>(lines) + line] = pattern_[2 * (line * n + s) + 1];
    }
  }
}

void UltrasoundArtefacts::begin() { std::fill(memory_.begin(), memory_.end(), 0.0F); }

void UltrasoundArtefacts::add(int sample, double depth_mm, float* real, float* imaginary, float* power) {
  const int wide = std::max(2, lines_ / 10);
  for (int l = 0; l < lines_; ++l)
    amplitude_[static_cast<std::size_t>(l) + 1] = amplitude_[static_cast<std::size_t>(l)] + std::sqrt(power[l]);
  const double sample_mm = sample > 0 ? depth_mm / sample : 0.0;
  const auto keep = static_cast<float>(std::exp(-sample_mm / kMemory_mm));
  const auto noise = static_cast<float>(std::pow(10.0, (kNoise_dB + kNoise_dB_per_mm * depth_mm) / 20.0));
  const float* const pattern_real = &rows_[2 * static_cast<std::size_t>(sample) * static_cast<std::size_t>(lines_)];
  const float* const pattern_imaginary = pattern_real + lines_;
  const auto ring = static_cast<float>(18.0 * std::exp(-depth_mm / kRings_mm) *
                                       (0.55 + 0.45 * std::cos(2.0 * std::numbers::pi * depth_mm / kRing_mm)));
  for (int l = 0; l < lines_; ++l) {
    const int from = std::max(0, l - wide), to = std::min(lines_, l + wide + 1);
    const float mean = (amplitude_[static_cast<std::size_t>(to)] - amplitude_[static_cast<std::size_t>(from)]) /
                       static_cast<float>(to - from);
    float& memory = memory_[static_cast<std::size_t>(l)];
    const float clutter = kSideLobes * mean + kReverberation * memory + noise;
    memory = keep * memory + (1.0F - keep) * std::min(mean, 4.0F);
    const float re = real[l] + clutter * pattern_real[l] + ring * (1.0F + 0.15F * pattern_imaginary[l]);
    const float im = imaginary[l] + clutter * pattern_imaginary[l];
    power[l] = re * re + im * im;
  }
}

}  // namespace stylet
