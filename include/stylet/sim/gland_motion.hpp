// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// How the gland, the union of the target regions, has moved as a whole after a step. Vectors have the components LR,
/// AP and SI, which are those of LPS: positive to the patient's left, to posterior and to superior.
struct GlandStep {
  double time_s = 0;
  double base_depth_mm = 0;
  Vec3 shift_mm = Vec3::Zero();      ///< mean over its volume
  Vec3 rotation_deg = Vec3::Zero();  ///< of the rigid motion that fits it best, about LR, AP and SI, right-handed
};

/// A rotation by the planes in which it turns [degrees]. Positive: coronal, the gland's superior end goes to the left;
/// sagittal, its superior end goes to anterior; transverse, its left side goes to posterior.
struct PlaneAngles {
  double coronal = 0;     ///< about AP
  double sagittal = 0;    ///< about LR
  double transverse = 0;  ///< about SI
};
/// @param rotation_deg as GlandStep::rotation_deg
inline PlaneAngles plane_angles(const Vec3& rotation_deg) {
  return {rotation_deg.y(), rotation_deg.x(), rotation_deg.z()};
}
inline Vec3 rotation_of(const PlaneAngles& angles) { return {angles.sagittal, angles.coronal, angles.transverse}; }

/// The motion of the gland over one insertion. Vectors as in GlandStep.
struct GlandMotion {
  std::optional<Vec3> shift_at_break_mm{};  ///< just before its surface broke; empty where it did not
  Vec3 shift_max_mm = Vec3::Zero();         ///< largest on the way in, the dwell included
  Vec3 shift_in_place_mm = Vec3::Zero();    ///< at the end of the dwell, before the needle goes out
  std::optional<Vec3> shift_residual_mm{};  ///< 1 s after the needle was out; empty where that is not known
  Vec3 rotation_deg = Vec3::Zero();         ///< when the shift was largest, as all that follows
  Vec3 base_mm = Vec3::Zero();              ///< mean shift of the superior third of its height
  Vec3 mid_mm = Vec3::Zero();               ///< of the middle third
  Vec3 apex_mm = Vec3::Zero();              ///< of the inferior third; NaN where a gland in pieces lacks a third
  double volume_change_percent = 0;         ///< relative change of its volume
};

/// A shift of the gland, or of a part of it, with what people call it.
struct NamedShift {
  std::string name;          ///< "largest", "base (superior third)"
  std::optional<Vec3> mm{};  ///< empty where there is none
};
/// All shifts of a motion: of the gland at its four moments, then of its thirds. Allocates.
std::vector<NamedShift> named_shifts(const GlandMotion& motion);

/// A turn in one plane, with where it goes in words.
struct NamedTurn {
  std::string plane;      ///< "coronal"
  double degrees = 0;     ///< signed, as in PlaneAngles
  std::string direction;  ///< "base to the left"
};
/// Of a motion, in the order coronal, sagittal, transverse. Allocates.
std::vector<NamedTurn> named_turns(const GlandMotion& motion);

}  // namespace stylet
