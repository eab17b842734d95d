// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/probe_place.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace stylet {

namespace {

constexpr double kProbeRadians = std::numbers::pi / 180.0;
constexpr double kLevel_mm = 10.0;  // half of the stretch of rectum whose middle counts

Vec3 middle_of(const TetMesh& mesh, std::size_t tet) {
  Vec3 sum = Vec3::Zero();
  for (const Index node : mesh.tets[tet]) sum += mesh.nodes[static_cast<std::size_t>(node)];
  return sum / 4.0;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// Axes of the probe at rest, as columns: x to the patient's right, y anterior, z superior.
Mat3 axes_at_rest() {
  Mat3 rest;
  rest.col(0) = -Vec3::UnitX();
  rest.col(1) = -Vec3::UnitY();
  rest.col(2) = Vec3::UnitZ();
  return rest;
}

}  // namespace

Result<ProbeSeat> probe_seat(const TetMesh& mesh, std::span<const int> gland_regions, const std::string& where) {
  Range gland;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (std::find(gland_regions.begin(), gland_regions.end(), mesh.tet_region[t]) == gland_regions.end()) continue;
    for (const Index node : mesh.tets[t]) gland.add(mesh.nodes[static_cast<std::size_t>(node)].z());
  }
  if (gland.low > gland.high)
    return input_error(where, "it has no gland, so the place of the probe is not known",
                       "Name a structure prostate, or set probe.kind = \"none\"");
  const double level = 0.5 * (gland.low + gland.high);
  const int wall = mesh.region_index("rectum");
  const int lumen = mesh.region_index("rectal_lumen");
  const int inside = lumen >= 0 ? lumen : wall;
  Vec3 sum = Vec3::Zero();
  double volume = 0.0;
  Range rectum;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const int region = mesh.tet_region[t];
    if (region < 0 || (region != wall && region != lumen)) continue;
    for (const Index node : mesh.tets[t]) rectum.add(mesh.nodes[static_cast<std::size_t>(node)].z());
    const Vec3 x = middle_of(mesh, t);
    if (region != inside || std::abs(x.z() - level) > kLevel_mm) continue;
    const double v = tet_volume(mesh, static_cast<Index>(t));
    sum += v * x;
    volume += v;
  }
  if (!(volume > 0.0))
    return input_error(where, "it has no rectum behind the gland, so no probe can be in it",
                       "Add a structure rectum, or set probe.kind = \"none\"");
  const Vec3 middle = sum / volume;
  return ProbeSeat{{middle.x(), middle.y(), rectum.low}, level};
}

ProbePlace probe_place(const ProbeSettings& settings, const ProbeSeat& seat) {
  // A tilt turns +z towards anterior, −y in LPS; a roll turns anterior towards the patient's left, +x.
  const Mat3 tilt = Eigen::AngleAxisd(settings.tilt_deg * kProbeRadians, Vec3::UnitX()).toRotationMatrix();
  const Mat3 roll = Eigen::AngleAxisd(settings.roll_deg * kProbeRadians, Vec3::UnitZ()).toRotationMatrix();
  ProbePlace place;
  place.axes = tilt * roll * axes_at_rest();
  const double depth = settings.depth_mm.value_or(seat.gland_mm) - seat.anus_mm.z();
  place.origin_mm = seat.anus_mm - settings.lift_mm * Vec3::UnitY() + depth * place.axes.col(2);
  place.radius_mm = 0.5 * settings.diameter_mm + settings.balloon_mm;
  return place;
}

Pose pose_of(const ProbePlace& place) { return {place.origin_mm, Eigen::Quaterniond(place.axes)}; }

StepperMotions stepper_motions(const Pose& pose, const ProbeSeat& seat) {
  // The rotation from rest is tilt · turn · roll, about x, y and z; a stepper has no turn.
  const Mat3 from_rest = pose.rotation.normalized().toRotationMatrix() * axes_at_rest().transpose();
  const double tilt = std::atan2(-from_rest(1, 2), from_rest(2, 2));
  const Vec3 from_anus = pose.origin - seat.anus_mm;
  // In the stepper's plane the origin lies at −lift · y + depth · (0, −sin tilt, cos tilt).
  const double depth = from_anus.z() / std::cos(tilt);
  StepperMotions motions;
  motions.depth_mm = depth + seat.anus_mm.z();
  motions.lift_mm = -from_anus.y() - depth * std::sin(tilt);
  motions.tilt_deg = tilt / kProbeRadians;
  motions.roll_deg = std::atan2(-from_rest(0, 1), from_rest(0, 0)) / kProbeRadians;
  motions.aside_mm = from_anus.x();
  motions.turned_deg = std::asin(std::clamp(from_rest(0, 2), -1.0, 1.0)) / kProbeRadians;
  return motions;
}

}  // namespace stylet
