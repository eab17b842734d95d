// SPDX-License-Identifier: GPL-3.0-or-later
#include "echo_picture.hpp"

#include "stylet/imaging/ultrasound_scanner.hpp"

#include <algorithm>
#include <bit>

namespace stylet {

namespace {

constexpr float kLogUnit_dB = 3.0103F;  // 10 log10(2)

/// log2 of a positive number, within 1e-5: the exponent, and a polynomial of the mantissa m that is exact at m = 1.
float quick_log2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  const auto m = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U);  // 1 … 2
  return exponent +
         (m - 1.0F) * (3.1157899F +
                       m * (-3.3241990F + m * (2.5988452F + m * (-1.2315303F + m * (0.31821337F - 0.034436006F * m)))));
}

}  // namespace

EchoPicture::EchoPicture(const UltrasoundSettings& settings, bool with_artefacts)
    : artefacts_(settings.lines, settings.samples, static_cast<std::uint32_t>(settings.random)),
      with_artefacts_(with_artefacts),
      power_(static_cast<std::size_t>(settings.lines) * static_cast<std::size_t>(settings.samples)),
      grey_(power_.size()) {}

void EchoPicture::compress(const UltrasoundBeams& beams, const UltrasoundSettings& settings, EchoField& field) {
  beams_ = beams;
  const auto range = static_cast<float>(settings.dynamic_range_dB);
  const float scale = 255.0F / range;
  if (with_artefacts_) artefacts_.begin();
  const auto n = static_cast<std::size_t>(beams.lines);
  for (int s = 0; s < beams.samples; ++s) {
    const double share = static_cast<double>(s) / (beams.samples - 1);
    const auto gained = range + static_cast<float>(hand_gain_dB(settings, share) - UltrasoundScanner::kWhite_dB);
    float* const row = &power_[static_cast<std::size_t>(s) * n];
    float* const real = field.row_real(s);
    float* const imaginary = field.row_imaginary(s);
    for (std::size_t l = 0; l < n; ++l) row[l] = real[l] * real[l] + imaginary[l] * imaginary[l];
    if (with_artefacts_) artefacts_.add(s, s * beams.sample_mm, real, imaginary, row);
    for (std::size_t l = 0; l < n; ++l) {
      const float dB = kLogUnit_dB * quick_log2(std::max(row[l], 1e-20F));
      const float rounded = std::clamp(scale * (dB + gained) + 0.5F, 0.0F, 255.0F);
      grey_[l * static_cast<std::size_t>(beams.samples) + static_cast<std::size_t>(s)] =
          static_cast<std::uint8_t>(rounded);
    }
  }
}

}  // namespace stylet
