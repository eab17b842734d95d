// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/xray_geometry.hpp"

#include <cmath>
#include <numbers>

namespace stylet {

XrayGeometry xray_geometry(const FluoroscopySettings& settings, const Vec3& centre_mm) {
  constexpr double degree = std::numbers::pi / 180.0;
  const double a = settings.angle_deg * degree;
  const double c = settings.cranial_deg * degree;
  XrayGeometry unit;
  unit.centre_mm = centre_mm;
  unit.towards = {std::sin(a) * std::cos(c), -std::cos(a) * std::cos(c), std::sin(c)};
  unit.right = {std::cos(a), std::sin(a), 0.0};
  unit.up = unit.right.cross(-unit.towards);
  unit.source_distance_mm = settings.source_mm - settings.detector_mm;
  unit.detector_mm = settings.detector_mm;
  unit.pixel_mm = settings.field_mm / settings.pixels;
  unit.pixels = settings.pixels;
  return unit;
}

}  // namespace stylet
