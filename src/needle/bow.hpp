// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/needle/section.hpp"

#include <cmath>
#include <numbers>

namespace stylet {

/// Direction of the curvature vector of a needle bowed by NeedleSection::bow_deg, base axes: the tip goes towards
/// (cos β, sin β, 0), so the tangent turns about (−sin β, cos β, 0).
inline Vec3 bow_axis(const NeedleSection& section) {
  const double angle = section.bow_deg * std::numbers::pi / 180.0;
  return {-std::sin(angle), std::cos(angle), 0.0};
}

/// Curvature k [1/mm] that puts the tip NeedleSection::bow_mm beside the axis.
/// @param offset tip's distance from the axis [mm] at curvature k, nearly proportional to it
template <class Offset>
double bow_curvature(const NeedleSection& section, const Offset& offset) {
  if (section.bow_mm == 0.0) return 0.0;
  double k = 2.0 * section.bow_mm / (section.length_mm * section.length_mm);
  constexpr int enough = 60;  // each round gains two digits or more
  for (int i = 0; i < enough; ++i) k *= section.bow_mm / offset(k);
  return k;
}

}  // namespace stylet
