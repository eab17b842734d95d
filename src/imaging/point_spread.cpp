// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_spread.hpp"

#include "speckle_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace stylet {

namespace {

const double kFullWidth = 2.0 * std::sqrt(2.0 * std::log(2.0));  // of a Gaussian, in standard deviations

/// Weights of a Gaussian from its middle outwards, whose sum over both sides is 1. @return half width
int gaussian(double deviation, int most, float* weights) {
  const int half = std::clamp(static_cast<int>(std::ceil(2.8 * deviation)), 0, most);
  double sum = 0.0;
  for (int k = 0; k <= half; ++k) {
    const double w = std::exp(-0.5 * k * k / std::max(1e-9, deviation * deviation));
    weights[k] = static_cast<float>(w);
    sum += k == 0 ? w : 2.0 * w;
  }
  for (int k = 0; k <= half; ++k) weights[k] = static_cast<float>(weights[k] / sum);
  return half;
}

/// Mean power of a sum over points of the speckle lattice at this distance from each other [mm].
double power_of(const float* weights, int half, double distance_mm) {
  double power = 0.0;
  for (int i = -half; i <= half; ++i) {
    for (int k = -half; k <= half; ++k)
      power += static_cast<double>(weights[std::abs(i)]) * static_cast<double>(weights[std::abs(k)]) *
               SpeckleLattice::correlation((i - k) * distance_mm);
  }
  return power;
}

}  // namespace

double BeamProfile::lateral_mm(double depth_mm) const {
  const double away = (depth_mm - focus_mm) / kFocalRange_mm;
  return wavelength_mm() * kF * std::sqrt(1.0 + away * away);
}

double BeamProfile::elevation_mm(double depth_mm) const {
  // The lens across the plane is weaker: its focal range is twice as long.
  const double away = (depth_mm - focus_mm) / (2.0 * kFocalRange_mm);
  return focal_elevation_mm * std::sqrt(1.0 + away * away);
}

PointSpread::PointSpread(const BeamProfile& profile, int samples)
    : profile_(profile),
      axial_(kMostSamples + 1),
      lateral_(static_cast<std::size_t>(samples) * (kMostLines + 1)),
      noise_(static_cast<std::size_t>(samples)),
      halves_(static_cast<std::size_t>(samples)) {}

void PointSpread::follow(const UltrasoundBeams& beams) {
  if (beams.sector == beams_.sector && beams.surface_mm == beams_.surface_mm && beams.step == beams_.step &&
      beams.sample_mm == beams_.sample_mm && beams.samples == beams_.samples)
    return;
  beams_ = beams;
  axial_half_ = gaussian(BeamProfile::kAxial_mm / kFullWidth / beams.sample_mm, kMostSamples, axial_.data());
  const double axial_power = power_of(axial_.data(), axial_half_, beams.sample_mm);
  for (int s = 0; s < beams.samples; ++s) {
    const auto row = static_cast<std::size_t>(s);
    const double depth = s * beams.sample_mm;
    const double spacing = beams.spacing_mm(depth);
    float* const weights = &lateral_[row * (kMostLines + 1)];
    halves_[row] = gaussian(profile_.lateral_mm(depth) / kFullWidth / spacing, kMostLines, weights);
    noise_[row] = static_cast<float>(1.0 / std::sqrt(axial_power * power_of(weights, halves_[row], spacing)));
  }
}

double PointSpread::width_in_lines(double depth_mm) const {
  const double deviation = profile_.lateral_mm(depth_mm) / kFullWidth;
  return std::max(1.0, std::sqrt(2.0 * std::numbers::pi) * deviation / beams_.spacing_mm(depth_mm));
}

}  // namespace stylet
