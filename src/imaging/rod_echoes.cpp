// SPDX-License-Identifier: GPL-3.0-or-later
#include "rod_echoes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr double kRodStep_mm = 0.15;  // of the points along a rod
constexpr double kFacetsWide = 0.7;   // extent of the facets across the lines, in diameters
constexpr double kTail_mm = 3.5;      // length over which a comet tail falls to 1/e

float amplitude_of(float dB) { return std::pow(10.0F, dB / 20.0F); }

/// Angles about the rod's axis, from where the beam meets it, and how much each part of the near side reflects.
struct Facet {
  double sine, cosine;
  float share;
};
const std::array<Facet, 5>& facets() {
  static const std::array<Facet, 5> all = [] {
    std::array<Facet, 5> made{};
    float sum = 0.0F;
    for (std::size_t k = 0; k < made.size(); ++k) {
      const double angle = (static_cast<double>(k) - 2.0) * 22.0 * std::numbers::pi / 180.0;
      made[k] = {std::sin(angle), std::cos(angle), static_cast<float>(std::pow(std::cos(angle), 6))};
      sum += made[k].share;
    }
    for (Facet& facet : made) facet.share /= sum;
    return made;
  }();
  return all;
}

}  // namespace

RodLook needle_look(double diameter_mm) {
  return {.level_dB = 33.0F,
          .rough_dB = -16.0F,
          .specular_deg = 16.0,
          .reverberations = 6,
          .reverberation_mm = 0.9 * diameter_mm,
          .reverberation_share = 0.36F,
          .tail_share = 0.16F,
          .shade = 0.45F};
}

RodLook seed_look(double diameter_mm) {
  return {.level_dB = 25.0F,
          .rough_dB = -14.0F,
          .specular_deg = 12.0,
          .reverberations = 3,
          .reverberation_mm = 1.2 * diameter_mm,
          .reverberation_share = 0.35F,
          .tail_share = 0.08F,
          .shade = 0.25F};
}

RodLook spacer_look() { return {.level_dB = 11.0F, .rough_dB = -6.0F, .specular_deg = 16.0, .shade = 0.05F}; }

RodLook track_look() { return {.level_dB = 12.0F, .rough_dB = -2.0F, .specular_deg = 30.0}; }

RodEchoes::RodEchoes(int lines, int samples)
    : lines_(lines),
      samples_(samples),
      sources_(static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples)),
      is_touched_(static_cast<std::size_t>(lines), 0) {
  facets();
}

void RodEchoes::clear() {
  for (int line = 0; line < lines_; ++line) {
    if (is_touched_[static_cast<std::size_t>(line)] == 0) continue;
    std::fill_n(sources_.begin() + static_cast<std::ptrdiff_t>(line) * samples_, samples_, Source{});
    is_touched_[static_cast<std::size_t>(line)] = 0;
  }
}

void RodEchoes::add(std::span<const Vec3> centreline_mm, double diameter_mm, const RodLook& look,
                    const UltrasoundBeams& beams, const BeamProfile& profile, const PointSpread& spread,
                    std::span<const float> gain, EchoField& field) {
  const Vec3 normal = beams.normal();
  const double radius = 0.5 * diameter_mm;
  const float strength = amplitude_of(look.level_dB) / spread.axial()[0];
  const float rough = amplitude_of(look.rough_dB);
  for (std::size_t k = 0; k + 1 < centreline_mm.size(); ++k) {
    const Vec3& from = centreline_mm[k];
    const Vec3 way = centreline_mm[k + 1] - from;
    const double length = way.norm();
    if (!(length > 0.0)) continue;
    const Vec3 axis = way / length;
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kRodStep_mm)));
    const double step = length / steps;
    const double e0 = normal.dot(from - beams.origin_mm), e1 = e0 + normal.dot(way);
    const double thickest = std::max(profile.elevation_mm(0.0), profile.elevation_mm(beams.sample_mm * samples_));
    if (std::min(std::abs(e0), std::abs(e1)) > thickest && e0 * e1 > 0.0) continue;
    for (int i = 0; i < steps; ++i) {
      const Vec3 x = from + (i + 0.5) * step * axis;
      const BeamPoint middle = beams.locate(x);
      if (middle.line < -2.0 || middle.line > lines_ + 1.0 || middle.depth_mm < 0.0) continue;
      const double elevation = profile.elevation_mm(middle.depth_mm);
      const double beside = middle.elevation_mm / (0.5 * elevation);
      if (std::abs(beside) > 1.8) continue;
      const double in_slice = std::exp(-std::numbers::ln10 * std::pow(beside, 4));
      const Eigen::Vector2d ray = beams.direction(middle.line);
      const Vec3 beam = ray.x() * beams.across + ray.y() * beams.ahead;
      const Vec3 lateral = ray.y() * beams.across - ray.x() * beams.ahead;
      const double along_beam = axis.dot(beam);
      const double tilt = std::asin(std::clamp(std::abs(along_beam), 0.0, 1.0));
      const double off = tilt / (look.specular_deg * std::numbers::pi / 180.0);
      const float mirror = rough + (1.0F - rough) * static_cast<float>(std::exp(-off * off));
      // A rod that lies across lines fills each of them. Where it passes through the slice it is one point, whose
      // facets lie beside each other on several lines.
      const double in_lines = std::abs(axis.dot(lateral)) / beams.spacing_mm(middle.depth_mm);
      const double facets_wide = 1.0 + kFacetsWide * diameter_mm / profile.lateral_mm(middle.depth_mm);
      const double through =
          std::abs(axis.dot(normal)) / elevation * spread.width_in_lines(middle.depth_mm) * facets_wide;
      const double deep = std::abs(along_beam) / std::max(1.0, 2.0 * radius);
      const auto share = static_cast<float>(step * std::sqrt(in_lines * in_lines + through * through + deep * deep));
      Vec3 towards = along_beam * axis - beam;  // from the axis to the near side
      const double size = towards.norm();
      towards = size > 1e-6 ? Vec3(towards / size) : Vec3(-beam);
      const Vec3 sideways = axis.cross(towards);
      for (const Facet& facet : facets()) {
        const Vec3 surface = x + radius * (facet.cosine * towards + facet.sine * sideways);
        const BeamPoint at = beams.locate(surface);
        const int line = static_cast<int>(std::lround(at.line));
        const int sample = static_cast<int>(std::floor(at.depth_mm / beams.sample_mm));
        if (line < 0 || line >= lines_ || sample < 1 || sample >= samples_) continue;
        const std::size_t place =
            static_cast<std::size_t>(line) * static_cast<std::size_t>(samples_) + static_cast<std::size_t>(sample);
        const float amplitude = strength * mirror * share * facet.share * static_cast<float>(in_slice) * gain[place];
        field.add(at.line, at.depth_mm / beams.sample_mm, amplitude, 1.0F, 0.0F);
        float echo = amplitude;
        for (int r = 1; r <= look.reverberations; ++r) {
          echo *= look.reverberation_share;
          // The echoes blur and lose their common phase.
          const double depth = at.depth_mm + r * look.reverberation_mm;
          field.add(at.line, depth / beams.sample_mm, echo, std::cos(1.7F * static_cast<float>(r)),
                    std::sin(1.7F * static_cast<float>(r)));
        }
        sources_[place].tail += amplitude * look.tail_share;
        sources_[place].shade += look.shade * share * facet.share * static_cast<float>(in_slice);
        is_touched_[static_cast<std::size_t>(line)] = 1;
      }
    }
  }
}

void RodEchoes::add_tails(std::span<const float> pattern, double sample_mm, EchoField& field) const {
  const auto decay = static_cast<float>(std::exp(-sample_mm / kTail_mm));
  for (int line = 0; line < lines_; ++line) {
    if (is_touched_[static_cast<std::size_t>(line)] == 0) continue;
    float* const real = field.real(line);
    float* const imaginary = field.imaginary(line);
    const std::size_t first = static_cast<std::size_t>(line) * static_cast<std::size_t>(samples_);
    float tail = 0.0F, passed = 1.0F;
    const auto behind = static_cast<int>(std::lround(1.5 / sample_mm));  // the shade begins behind the rod itself
    for (int s = 0; s < samples_; ++s) {
      const std::size_t at = first + static_cast<std::size_t>(s);
      if (s >= behind) passed *= 1.0F - std::min(0.6F, sources_[at - static_cast<std::size_t>(behind)].shade);
      tail = decay * tail + sources_[at].tail;
      real[s] = passed * real[s] + tail * pattern[2 * at];
      imaginary[s] = passed * imaginary[s] + tail * pattern[2 * at + 1];
    }
  }
}

}  // namespace stylet
