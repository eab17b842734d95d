// SPDX-License-Identifier: GPL-3.0-or-later
#include "border_echoes.hpp"

#include "tissue_speckle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace stylet {

namespace {

constexpr double kPatch = 0.12;         // patches of a border are larger than speckle by its inverse
constexpr int kRoughParts = 14;         // echoes behind the surface of bone,
constexpr double kRoughPart_mm = 0.22;  // their distance,
constexpr float kRoughShare = 0.80F;    // and the amplitude of each, relative to the one before

}  // namespace

BorderEchoes::BorderEchoes(const TetMesh& mesh, int lines) : mesh_(mesh) {
  for (const std::string& region : mesh.regions) roles_.push_back(tissue_role(region));
  hits_.reserve(static_cast<std::size_t>(lines) * 64);
}

void BorderEchoes::note(const BeamSpan& span) {
  if (span.behind < 0 || hits_.size() == hits_.capacity()) return;
  const int here = mesh_.tet_region[static_cast<std::size_t>(span.tet)];
  const int there = mesh_.tet_region[static_cast<std::size_t>(span.behind)];
  if (here == there) return;
  const InterfaceEcho echo =
      interface_echo(roles_[static_cast<std::size_t>(here)], roles_[static_cast<std::size_t>(there)]);
  const auto facing = static_cast<float>(std::abs(span.cosine));
  hits_.push_back({span.line, static_cast<float>(span.to_mm),
                   amplitude_of_dB(echo.level_dB) * std::pow(facing, echo.falloff), echo.roughness_mm,
                   span.undeformed_mm + span.to_mm * span.course});
}

void BorderEchoes::add(const UltrasoundBeams& beams, std::span<const float> gain, const SpeckleLattice& lattice,
                       const PointSpread& spread, EchoField& field) const {
  for (const Hit& hit : hits_) {
    const double sample = static_cast<double>(hit.depth_mm) / beams.sample_mm;
    const auto at = static_cast<std::size_t>(std::clamp(static_cast<int>(sample), 0, beams.samples - 1));
    const float passed = gain[static_cast<std::size_t>(hit.line) * static_cast<std::size_t>(beams.samples) + at];
    // A border is not equally smooth everywhere.
    const std::complex<float> patch = lattice.at(lattice.position(kPatch * hit.at));
    const float strength = hit.amplitude * passed / spread.axial()[0];
    const double rough = hit.roughness_mm * static_cast<double>(patch.imag()) / beams.sample_mm;
    field.add(hit.line, sample + rough, strength, 0.5F + 0.6F * patch.real(), 0.4F * patch.imag());
    if (hit.roughness_mm < 0.2) continue;
    // Parts of a rough surface lie deeper, differently from line to line, and echoes are reflected several times before
    // it.
    float part_strength = 0.7F * strength;
    for (int k = 1; k <= kRoughParts; ++k) {
      const std::complex<float> part = lattice.at(lattice.position((1.0 + 0.3 * k) * hit.at));
      field.add(hit.line, sample + std::abs(rough) + kRoughPart_mm * k / beams.sample_mm, part_strength, part.real(),
                part.imag());
      part_strength *= kRoughShare;
    }
  }
}

}  // namespace stylet
