// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/ultrasound_beams.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace stylet {

Vec3 UltrasoundBeams::normal() const { return across.cross(ahead); }

Eigen::Vector2d UltrasoundBeams::direction(double line) const {
  if (!sector) return {0.0, 1.0};
  const double angle = first + line * step;
  return {std::sin(angle), std::cos(angle)};
}

Eigen::Vector2d UltrasoundBeams::start_mm(double line) const {
  if (!sector) return {first + line * step, surface_mm};
  return surface_mm * direction(line);
}

double UltrasoundBeams::spacing_mm(double depth_mm) const { return sector ? step * (surface_mm + depth_mm) : step; }

BeamPoint UltrasoundBeams::locate(const Eigen::Vector2d& in_plane) const {
  if (!sector) return {(in_plane.x() - first) / step, in_plane.y() - surface_mm, 0.0};
  return {(std::atan2(in_plane.x(), in_plane.y()) - first) / step, in_plane.norm() - surface_mm, 0.0};
}

BeamPoint UltrasoundBeams::locate(const Vec3& x) const {
  const Vec3 from = x - origin_mm;
  BeamPoint point = locate(Eigen::Vector2d(across.dot(from), ahead.dot(from)));
  point.elevation_mm = normal().dot(from);
  return point;
}

Vec3 UltrasoundBeams::point_mm(double line, double depth_mm) const {
  const Eigen::Vector2d at = start_mm(line) + depth_mm * direction(line);
  return origin_mm + at.x() * across + at.y() * ahead;
}

UltrasoundBeams ultrasound_beams(ProbeKind kind, const ProbePlace& place, const UltrasoundSettings& settings,
                                 UltrasoundArray array) {
  UltrasoundBeams beams;
  beams.origin_mm = place.origin_mm;
  beams.surface_mm = place.radius_mm;
  beams.lines = settings.lines;
  beams.samples = settings.samples;
  beams.sample_mm = settings.depth_mm / (settings.samples - 1);
  const bool transverse = array == UltrasoundArray::transverse;
  if (kind == ProbeKind::endfire) {
    beams.ahead = place.axes.col(2);
    if (transverse) {
      beams.across = -place.axes.col(0);
    } else {
      beams.across = place.axes.col(1);
    }
  } else {
    beams.ahead = place.axes.col(1);
    beams.across = -place.axes.col(transverse ? 0 : 2);
    beams.sector = transverse;
  }
  const double width = beams.sector ? settings.sector_deg * std::numbers::pi / 180.0 : settings.length_mm;
  beams.step = width / (settings.lines - 1);
  beams.first = -0.5 * width;
  return beams;
}

}  // namespace stylet
