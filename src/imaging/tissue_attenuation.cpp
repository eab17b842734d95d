// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_attenuation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet {

namespace {

constexpr double kConcretion_dB_per_cm_MHz = 14.0;  // attenuation of concretions, as of bone
constexpr double kShadowStep_mm = 2.5;              // depth after which shadows are blurred across the lines,
constexpr double kShadowBlur_mm = 1.2;              // over so much to both sides
constexpr float kLargestGain = 3.16F;               // 10 dB: the receiver's limit behind tissue that attenuates less
constexpr float kSmallestGain = 1e-12F;             // keeps numbers normal

}  // namespace

TissueAttenuation::TissueAttenuation(int lines, int samples)
    : passed_(static_cast<std::size_t>(lines)),
      blurred_(passed_.size()),
      gain_(passed_.size() * static_cast<std::size_t>(samples)) {}

void TissueAttenuation::apply(const UltrasoundBeams& beams, double frequency_MHz, const TetMesh& mesh,
                              std::span<const TissueEcho> echoes, std::span<const Index> tets,
                              std::span<const std::uint8_t> is_concretion, EchoField& field) {
  const double way_cm = 0.2 * beams.sample_mm;  // there and back
  const auto factor_of = [&](double dB_per_cm_MHz) {
    const double dB = (dB_per_cm_MHz - UltrasoundScanner::kCompensated_dB_per_cm_MHz) * frequency_MHz * way_cm;
    return static_cast<float>(std::pow(10.0, -dB / 20.0));
  };
  std::array<float, 256> factors{};
  for (std::size_t r = 0; r < echoes.size(); ++r)
    factors[std::min<std::size_t>(r, 255)] = factor_of(echoes[r].attenuation_dB_per_cm_MHz);
  const float concretion = factor_of(kConcretion_dB_per_cm_MHz);
  std::fill(passed_.begin(), passed_.end(), 1.0F);
  const auto samples = static_cast<std::size_t>(beams.samples);
  const std::size_t step = std::max<std::size_t>(1, static_cast<std::size_t>(kShadowStep_mm / beams.sample_mm));
  for (std::size_t from = 0; from < samples; from += step) {
    const std::size_t to = std::min(samples, from + step);
    for (int line = 0; line < beams.lines; ++line) {
      const std::size_t first = static_cast<std::size_t>(line) * samples;
      float* const real = field.real(line);
      float* const imaginary = field.imaginary(line);
      float passed = passed_[static_cast<std::size_t>(line)];
      for (std::size_t s = from; s < to; ++s) {
        gain_[first + s] = passed;
        real[s] *= passed;
        imaginary[s] *= passed;
        const Index tet = tets[first + s];
        if (tet < 0) continue;
        const auto region = static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(tet)]);
        passed *= is_concretion[first + s] != 0 ? concretion : factors[std::min<std::size_t>(region, 255)];
        passed = std::clamp(passed, kSmallestGain, kLargestGain);
      }
      passed_[static_cast<std::size_t>(line)] = passed;
    }
    blur_shadows(beams, static_cast<double>(to) * beams.sample_mm);
  }
}

/// Blurs what passes across the lines: the aperture is as wide as the depth over F, so that something small shades less
/// the deeper one looks behind it, and shadows have soft edges.
void TissueAttenuation::blur_shadows(const UltrasoundBeams& beams, double depth_mm) {
  const int half = static_cast<int>(std::lround(kShadowBlur_mm / beams.spacing_mm(depth_mm)));
  if (half < 1) return;
  const auto at = [&](int line) { return passed_[static_cast<std::size_t>(std::clamp(line, 0, beams.lines - 1))]; };
  float sum = 0.0F;
  for (int line = -half; line <= half; ++line) sum += at(line);
  const float weight = 1.0F / static_cast<float>(2 * half + 1);
  for (int line = 0; line < beams.lines; ++line) {
    blurred_[static_cast<std::size_t>(line)] = std::max(weight * sum, kSmallestGain);
    sum += at(line + half + 1) - at(line - half);
  }
  passed_.swap(blurred_);
}

}  // namespace stylet
