// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/needle/section.hpp"

#include <cmath>
#include <numbers>

namespace stylet {

/// Direction of the curvature vector of a needle with the bow NeedleSection::bow_deg = β, base axes. The tip deviates
/// towards (cos β, sin β, 0), so the tangent turns about (−sin β, cos β, 0).
inline Vec3 bow_axis(const NeedleSection& section) {
  const double angle = section.bow_deg * std::numbers::pi / 180.0;
  return {-std::sin(angle), std::cos(angle), 0.0};
}

/// Curvature k [1/mm] with which the tip is NeedleSection::bow_mm beside the axis.
/// @param offset returns the tip's distance from the axis [mm] for a curvature k; nearly proportional to k
template <class Offset>
double bow_curvature(const NeedleSection& section, const Offset& offset) {
  if (section.bow_mm == 0.0) return 0.0;
  double k = 2.0 * section.bow_mm / (section.length_mm * section.length_mm);
  constexpr int enough = 60;  // each round gains at least two digits
  for (int i = 0; i < enough; ++i) k *= section.bow_mm / offset(k);
  return k;
}

}  // namespace stylet
