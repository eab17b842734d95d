// SPDX-License-Identifier: GPL-3.0-or-later
#include "echo_field.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

constexpr int kBlock = 8;  // lines that are blurred and turned into rows together

}  // namespace

EchoField::EchoField(int lines, int samples)
    : lines_(lines),
      samples_(samples),
      real_(static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples)),
      imaginary_(real_.size()),
      row_real_(real_.size()),
      row_imaginary_(real_.size()),
      block_(static_cast<std::size_t>(kBlock + 1) * static_cast<std::size_t>(samples + 2 * PointSpread::kMostSamples)),
      padded_(static_cast<std::size_t>(lines + 2 * PointSpread::kMostLines)) {}

void EchoField::clear() {
  std::fill(real_.begin(), real_.end(), 0.0F);
  std::fill(imaginary_.begin(), imaginary_.end(), 0.0F);
}

void EchoField::add(double line, double sample, float amplitude, float phase_real, float phase_imaginary) {
  const double l0 = std::floor(line), s0 = std::floor(sample);
  for (int i = 0; i < 2; ++i) {
    const int l = static_cast<int>(l0) + i;
    if (l < 0 || l >= lines_) continue;
    const double across = i == 0 ? 1.0 - (line - l0) : line - l0;
    for (int k = 0; k < 2; ++k) {
      const int s = static_cast<int>(s0) + k;
      if (s < 0 || s >= samples_) continue;
      const double along = k == 0 ? 1.0 - (sample - s0) : sample - s0;
      const auto share = amplitude * static_cast<float>(across * along);
      real(l)[s] += share * phase_real;
      imaginary(l)[s] += share * phase_imaginary;
    }
  }
}

void EchoField::blur(const PointSpread& spread) {
  blur_along(real_, spread, row_real_);
  blur_along(imaginary_, spread, row_imaginary_);
  blur_across(spread, row_real_);
  blur_across(spread, row_imaginary_);
}

void EchoField::blur_along(const std::vector<float>& lines, const PointSpread& spread, std::vector<float>& rows) {
  const auto n = static_cast<std::size_t>(samples_);
  const auto pad = static_cast<std::size_t>(PointSpread::kMostSamples);
  float* const line = block_.data();  // padded with zeros
  std::fill(line, line + n + 2 * pad, 0.0F);
  for (int first = 0; first < lines_; first += kBlock) {
    const int count = std::min(kBlock, lines_ - first);
    for (int l = 0; l < count; ++l) {
      std::copy_n(&lines[at(first + l)], n, line + pad);
      float* const out = block_.data() + static_cast<std::size_t>(l + 1) * (n + 2 * pad);
      const float middle = spread.axial()[0];
      for (std::size_t s = 0; s < n; ++s) out[s] = middle * line[pad + s];
      for (int k = 1; k <= spread.axial_half(); ++k) {
        const float w = spread.axial()[k];
        const float* const before = line + pad - static_cast<std::size_t>(k);
        const float* const after = line + pad + static_cast<std::size_t>(k);
        for (std::size_t s = 0; s < n; ++s) out[s] += w * (before[s] + after[s]);
      }
    }
    for (std::size_t s = 0; s < n; ++s) {
      float* const row = &rows[row_at(static_cast<int>(s)) + static_cast<std::size_t>(first)];
      for (int l = 0; l < count; ++l) row[l] = block_[static_cast<std::size_t>(l + 1) * (n + 2 * pad) + s];
    }
  }
}

void EchoField::blur_across(const PointSpread& spread, std::vector<float>& rows) {
  const auto n = static_cast<std::size_t>(lines_);
  const auto pad = static_cast<std::size_t>(PointSpread::kMostLines);
  for (int s = 0; s < samples_; ++s) {
    const int half = spread.lateral_half(s);
    if (half == 0) continue;
    float* const row = &rows[row_at(s)];
    float* const in = padded_.data();
    std::copy_n(row, n, in + pad);
    for (std::size_t k = 1; k <= static_cast<std::size_t>(half); ++k) {
      in[pad - k] = row[std::min(k, n - 1)];
      in[pad + n - 1 + k] = row[n - 1 - std::min(k, n - 1)];
    }
    const float* const weights = spread.lateral(s);
    for (std::size_t l = 0; l < n; ++l) row[l] = weights[0] * in[pad + l];
    for (int k = 1; k <= half; ++k) {
      const float w = weights[k];
      const float* const before = in + pad - static_cast<std::size_t>(k);
      const float* const after = in + pad + static_cast<std::size_t>(k);
      for (std::size_t l = 0; l < n; ++l) row[l] += w * (before[l] + after[l]);
    }
  }
}

}  // namespace stylet
