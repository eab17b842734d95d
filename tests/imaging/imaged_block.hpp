// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/box_mesh.hpp"
#include "stylet/imaging/ultrasound_scanner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace stylet::test {

/// Attenuation that the gain with depth compensates: speckle keeps its level.
inline constexpr double kLevel = UltrasoundScanner::kCompensated_dB_per_cm_MHz;

/// A block of 80 × 100 × 60 mm that is looked at along +y from y = 0.
inline TetMesh imaged_block(
    std::vector<std::string> regions = {"body"},
    const std::function<int(const Vec3&)>& region_at = [](const Vec3&) { return 0; }) {
  TetMesh mesh = box_mesh({-40, 0, -30}, {40, 100, 30}, {8, 20, 6});
  assign_regions(mesh, std::move(regions), region_at);
  return mesh;
}

/// A linear array of 256 lines over 64 mm, or a sector; both look along +y with x across, and start at y = 0.
inline UltrasoundBeams block_beams(const UltrasoundSettings& settings, bool sector = false) {
  UltrasoundBeams beams;
  beams.sector = sector;
  beams.across = Vec3::UnitX();
  beams.ahead = Vec3::UnitY();
  beams.surface_mm = sector ? 10.0 : 0.0;
  beams.origin_mm = sector ? Vec3(0, -10, 0.3) : Vec3(0, 0, 0.3);
  beams.lines = settings.lines;
  beams.samples = settings.samples;
  beams.sample_mm = settings.depth_mm / (settings.samples - 1);
  beams.step = (sector ? 1.0 : 64.0) / (settings.lines - 1);
  beams.first = -0.5 * beams.step * (settings.lines - 1);
  return beams;
}

/// A scanner of a block, without anatomy and artefacts.
inline UltrasoundScanner plain_scanner(const TetMesh& mesh, const std::vector<TissueEcho>& echoes,
                                       const UltrasoundSettings& settings = {}) {
  auto scanner = UltrasoundScanner::create(mesh, echoes, settings, {.anatomy = false, .artefacts = false});
  if (!scanner) throw std::runtime_error(scanner.error().message());
  return *std::move(scanner);
}

/// Mean power of the last picture over some lines and samples [dB].
inline double mean_dB(const UltrasoundScanner& scanner, int first_line, int last_line, double from_mm, double to_mm,
                      double sample_mm) {
  double sum = 0.0;
  int count = 0;
  for (int line = first_line; line <= last_line; ++line) {
    for (int s = static_cast<int>(from_mm / sample_mm); s <= static_cast<int>(to_mm / sample_mm); ++s) {
      sum += std::pow(10.0, scanner.level_dB(line, s) / 10.0);
      ++count;
    }
  }
  return 10.0 * std::log10(sum / count);
}

}  // namespace stylet::test
