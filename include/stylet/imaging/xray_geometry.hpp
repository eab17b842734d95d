// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/sim/imaging_settings.hpp"

namespace stylet {

/// Source and detector of an X-ray unit: a C-arm that turns about a centre. The picture is seen from the detector, so
/// that at an angle of 0 the patient's left is on the right side and superior is up.
struct XrayGeometry {
  /// A point's place in the picture.
  struct Place {
    double column, row;  ///< centres of pixels are at whole numbers, counted from 0
    double depth_mm;     ///< distance from the source along the central ray
  };

  Vec3 centre_mm = Vec3::Zero();    ///< LPS, where the central ray and the axis of the C-arm meet
  Vec3 towards = -Vec3::UnitY();    ///< unit vector from the source to the detector
  Vec3 right = Vec3::UnitX();       ///< unit vector of the picture's rows
  Vec3 up = Vec3::UnitZ();          ///< unit vector
  double source_distance_mm = 0.0;  ///< of source and centre
  double detector_mm = 0.0;         ///< distance of centre and detector
  double pixel_mm = 0.0;            ///< width of a pixel, measured at the centre
  int pixels = 0;                   ///< along a side

  [[nodiscard]] Vec3 source_mm() const { return centre_mm - source_distance_mm * towards; }
  [[nodiscard]] double middle() const { return 0.5 * (pixels - 1); }  ///< column and row of the central ray

  /// @param x [mm] LPS, farther from the source than 0 along the central ray
  [[nodiscard]] Place place(const Vec3& x) const {
    const Vec3 from_source = x - source_mm();
    const double depth = from_source.dot(towards);
    const double scale = source_distance_mm / (depth * pixel_mm);
    return {middle() + scale * from_source.dot(right), middle() - scale * from_source.dot(up), depth};
  }

  /// The ray through a place of the picture, of length 1 along the central ray.
  [[nodiscard]] Vec3 ray(double column, double row) const {
    const double scale = pixel_mm / source_distance_mm;
    return towards + scale * (column - middle()) * right - scale * (row - middle()) * up;
  }
};

/// The X-ray unit of some settings.
/// @param centre_mm LPS, the point about which the C-arm turns
XrayGeometry xray_geometry(const FluoroscopySettings& settings, const Vec3& centre_mm);

}  // namespace stylet
