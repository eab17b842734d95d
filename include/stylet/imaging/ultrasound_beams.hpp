// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/probe/probe_place.hpp"

namespace stylet {

/// A point of an ultrasound picture: where on which line, and how far beside the plane.
struct BeamPoint {
  double line = 0.0;          ///< number of the line, with a fraction; may be outside of 0 … lines − 1
  double depth_mm = 0.0;      ///< from the probe's surface along the line
  double elevation_mm = 0.0;  ///< signed distance from the plane
};

/// The lines of an ultrasound picture in space. A sector fans out from a centre behind the probe's surface; a linear
/// array has parallel lines.
///
/// In the plane of the picture positions are (across, ahead) from the origin; lines go from the viewer's left to the
/// viewer's right, along +across, when ahead is up.
struct UltrasoundBeams {
  Vec3 origin_mm = Vec3::Zero();  ///< LPS: centre of a sector; on the probe's axis, behind the middle, of linear arrays
  Vec3 across = Vec3::UnitX();    ///< unit vector, LPS
  Vec3 ahead = -Vec3::UnitY();    ///< unit vector, LPS: direction of the middle line
  bool sector = true;             ///< lines fan out
  double surface_mm = 10.0;       ///< from the origin to the probe's surface
  double first = 0.0;             ///< of the first line: angle from `ahead` [rad], or place along `across` [mm]
  double step = 0.0;              ///< from line to line, as `first`
  int lines = 0;
  int samples = 0;
  double sample_mm = 0.0;  ///< distance of samples along a line; sample s is at the depth s · sample_mm

  /// Unit normal of the plane, LPS.
  [[nodiscard]] Vec3 normal() const;
  /// Direction of a line in the plane (across, ahead).
  [[nodiscard]] Eigen::Vector2d direction(double line) const;
  /// Place in the plane at which a line leaves the probe's surface [mm].
  [[nodiscard]] Eigen::Vector2d start_mm(double line) const;
  /// Distance of neighbouring lines at a depth [mm].
  [[nodiscard]] double spacing_mm(double depth_mm) const;
  /// A place in the plane (across, ahead) [mm] as line and depth.
  [[nodiscard]] BeamPoint locate(const Eigen::Vector2d& in_plane) const;
  /// A point of the patient [mm] LPS as line, depth and elevation.
  [[nodiscard]] BeamPoint locate(const Vec3& x) const;
  /// The point of the patient [mm] LPS at a depth of a line.
  [[nodiscard]] Vec3 point_mm(double line, double depth_mm) const;
};

/// The lines of an array of the probe.
/// - biplane, transverse: a sector in the plane across the axis, the patient's left on the viewer's right without roll
/// - biplane, sagittal: parallel lines in the plane of the axis and the roll's direction, superior on the viewer's
/// left,
///   with the middle of the array at the place's origin
/// - endfire: a sector about the axis, from the origin as its centre; the array sagittal lies in the plane of axis and
///   roll's direction (ahead is up, anterior on the viewer's right), transverse across it
UltrasoundBeams ultrasound_beams(ProbeKind kind, const ProbePlace& place, const UltrasoundSettings& settings,
                                 UltrasoundArray array);

}  // namespace stylet
