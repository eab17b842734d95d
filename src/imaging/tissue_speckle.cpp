// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_speckle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace stylet {

namespace {

constexpr double kSlicePoint = 0.23;  // standard deviation of the slice's profile, in thicknesses

}  // namespace

float amplitude_of_dB(double dB) { return static_cast<float>(std::pow(10.0, dB / 20.0)); }

void SampledTissue::clear() {
  std::fill(tets.begin(), tets.end(), Index{-1});
  std::fill(is_concretion.begin(), is_concretion.end(), std::uint8_t{0});
}

TissueSpeckle::TissueSpeckle(std::span<const TissueEcho> echoes, std::shared_ptr<const EchoMap> map, std::uint32_t seed,
                             int samples)
    : lattice_(seed), map_(std::move(map)), slice_mm_(static_cast<std::size_t>(samples)) {
  for (const TissueEcho& echo : echoes) amplitudes_.push_back(amplitude_of_dB(echo.echo_dB));
  for (std::size_t level = 0; level < of_level_.size(); ++level)
    of_level_[level] = amplitude_of_dB(EchoMap::kDarkest_dB + EchoMap::kStep_dB * static_cast<double>(level));
}

void TissueSpeckle::begin(const UltrasoundBeams& beams, const BeamProfile& profile) {
  for (int s = 0; s < beams.samples; ++s)
    slice_mm_[static_cast<std::size_t>(s)] =
        static_cast<float>(kSlicePoint * profile.elevation_mm(s * beams.sample_mm));
}

void TissueSpeckle::fill(const SpeckleScene& scene, const BeamSpan& span, std::size_t region, SampledTissue& tissue,
                         EchoField& field) const {
  const UltrasoundBeams& beams = scene.beams;
  const int from = static_cast<int>(std::ceil(span.from_mm / beams.sample_mm - 1e-7));
  const int to = std::min(beams.samples - 1, static_cast<int>(std::floor(span.to_mm / beams.sample_mm + 1e-7)));
  if (from > to) return;
  const std::size_t line = static_cast<std::size_t>(span.line) * static_cast<std::size_t>(beams.samples);
  std::fill(tissue.tets.begin() + static_cast<std::ptrdiff_t>(line) + from,
            tissue.tets.begin() + static_cast<std::ptrdiff_t>(line) + to + 1, span.tet);
  fill_row(scene, span.line, from, to, amplitudes_[region], span.undeformed_mm, span.course * beams.sample_mm, tissue,
           field);
}

void TissueSpeckle::fill_row(const SpeckleScene& scene, int line, int from, int to, float amplitude, const Vec3& x0,
                             const Vec3& dx, SampledTissue& tissue, EchoField& field) const {
  constexpr int kLevelStep = 5;  // samples from one look at the map to the next
  const UltrasoundBeams& beams = scene.beams;
  const MaterialShift& shift = scene.shift;
  const Eigen::Vector3f p0 = lattice_.position(x0), dp = lattice_.difference(dx);
  float* const real = field.real(line);
  float* const imaginary = field.imaginary(line);
  const bool shifted = shift.touches(line, from, to);
  const std::size_t first = static_cast<std::size_t>(line) * static_cast<std::size_t>(beams.samples);
  const Eigen::Vector3f normal = EchoMap::difference(beams.normal());
  const auto level_at = [&](int s) {
    Vec3 x = x0 + s * dx;
    if (shifted) x += shift.at(line, s).cast<double>();
    const Eigen::Vector3f at = map_->position(x), beside = slice_mm_[static_cast<std::size_t>(s)] * normal;
    return map_->mean_power(at - beside, at + beside);
  };
  Eigen::Vector3f moved = Eigen::Vector3f::Zero(), move = Eigen::Vector3f::Zero();  // on the lattice
  float level = -1.0F, slope = 0.0F;  // of the map at a sample, and from one sample to the next
  float next_level = map_ ? level_at(from) : -1.0F;
  int next_look = map_ ? from : to + 1;
  for (int s = from; s <= to; ++s) {
    if (s == next_look) {
      const int then = std::min(s + kLevelStep, to);
      level = next_level;
      next_level = level_at(then);
      slope =
          next_level >= 0.0F && level >= 0.0F ? (next_level - level) / static_cast<float>(std::max(1, then - s)) : 0.0F;
      next_look = s + kLevelStep;
    }
    float share = amplitude;
    if (level >= 0.0F) {
      share = of_level_[static_cast<std::size_t>(std::min(255.0F, level + 0.5F))];
      if (level > EchoMap::kCalcified) tissue.is_concretion[first + static_cast<std::size_t>(s)] = 1;
      level += slope;
    }
    Eigen::Vector3f p = p0 + static_cast<float>(s) * dp;
    if (shifted) {
      if (s == from || s % MaterialShift::kSampleStep == 0) {  // linear in between
        const int next = (s / MaterialShift::kSampleStep + 1) * MaterialShift::kSampleStep;
        moved = lattice_.difference(shift.at(line, s).cast<double>());
        move = (lattice_.difference(shift.at(line, next).cast<double>()) - moved) / static_cast<float>(next - s);
      }
      p += moved;
      moved += move;
    }
    const std::complex<float> noise = lattice_.at(p);
    share *= scene.spread.noise_scale(s);
    real[s] = share * noise.real();
    imaginary[s] = share * noise.imag();
  }
}

}  // namespace stylet
