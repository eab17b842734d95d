// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// Rigid part of the motion of the gland, which is the union of the target regions, after a step. Vectors have the
/// components LR, AP and SI of LPS: positive to the patient's left, to posterior and to superior.
struct GlandStep {
  double time_s = 0;
  double base_depth_mm = 0;
  Vec3 shift_mm = Vec3::Zero();      ///< mean displacement over the gland's volume
  Vec3 rotation_deg = Vec3::Zero();  ///< rotation of the best-fitting rigid motion, about LR, AP and SI, right-handed
};

/// A rotation of the gland as an angle [°] in each anatomical plane. Positive angles: coronal, the gland's superior end
/// goes to the left; sagittal, its superior end goes to anterior; transverse, its left side goes to posterior.
struct PlaneAngles {
  double coronal = 0;     ///< about AP
  double sagittal = 0;    ///< about LR
  double transverse = 0;  ///< about SI
};
/// Converts a rotation vector to angles in the anatomical planes. @param rotation_deg as GlandStep::rotation_deg
inline PlaneAngles plane_angles(const Vec3& rotation_deg) {
  return {rotation_deg.y(), rotation_deg.x(), rotation_deg.z()};
}
/// The inverse of plane_angles().
inline Vec3 rotation_of(const PlaneAngles& angles) { return {angles.sagittal, angles.coronal, angles.transverse}; }

/// The motion of the gland over one insertion. Vectors as in GlandStep.
struct GlandMotion {
  std::optional<Vec3> shift_at_break_mm{};  ///< shift just before the gland's surface broke; empty if it did not break
  Vec3 shift_max_mm = Vec3::Zero();         ///< largest shift on the way in, the dwell included
  Vec3 shift_in_place_mm = Vec3::Zero();    ///< shift at the end of the dwell, before the needle is drawn out
  std::optional<Vec3> shift_residual_mm{};  ///< shift 1 s after the needle was out; empty if unknown

  // The members below describe the moment of shift_max_mm. A third is a third of the gland's height; its shift is NaN
  // if a gland in several pieces has no tissue there.
  Vec3 rotation_deg = Vec3::Zero();  ///< rotation of the gland, as GlandStep::rotation_deg
  Vec3 base_mm = Vec3::Zero();       ///< mean shift of the superior third
  Vec3 mid_mm = Vec3::Zero();        ///< mean shift of the middle third
  Vec3 apex_mm = Vec3::Zero();       ///< mean shift of the inferior third
  double volume_change_percent = 0;  ///< relative change of the gland's volume
};

/// A shift of the gland or of a part of it, with its name in reports.
struct NamedShift {
  std::string name;          ///< "largest", "base (superior third)"
  std::optional<Vec3> mm{};  ///< [mm] LPS; empty if unknown
};
/// All shifts of a motion: the shift of the whole gland at four moments, then the shifts of its thirds. Allocates.
std::vector<NamedShift> named_shifts(const GlandMotion& motion);

/// A rotation in one anatomical plane, with its direction in words.
struct NamedTurn {
  std::string plane;      ///< "coronal"
  double degrees = 0;     ///< signed, as in PlaneAngles
  std::string direction;  ///< "base to the left"
};
/// The turns of a motion in the order coronal, sagittal, transverse. Allocates.
std::vector<NamedTurn> named_turns(const GlandMotion& motion);

}  // namespace stylet
