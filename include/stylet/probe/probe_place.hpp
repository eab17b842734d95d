// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/imaging_settings.hpp"

#include <span>
#include <string>

namespace stylet {

/// Where the probe enters and rests in a patient, found from the mesh.
struct ProbeSeat {
  Vec3 anus_mm = Vec3::Zero();  ///< LPS, inferior end of the rectum, on the axis of the probe at rest
  double gland_mm = 0.0;        ///< LPS z of the gland's middle
};

/// The seat of a probe in the rectum (regions rectal_lumen, or else rectum): the axis is along z through the middle of
/// the rectum at the level of the gland.
/// Errors: no gland, or no rectum at its level. @param where name of the patient in messages
Result<ProbeSeat> probe_seat(const TetMesh& mesh, std::span<const int> gland_regions, const std::string& where);

/// The place of a rigid probe.
struct ProbePlace {
  Vec3 origin_mm = Vec3::Zero();  ///< LPS, on the axis, in the middle of the transverse array
  /// Directions in LPS as columns: x to the side, y where the sagittal array looks (anterior without roll), z along the
  /// axis towards the rounded end; right-handed.
  Mat3 axes = Mat3::Identity();
  double radius_mm = 10.0;  ///< of the probe with its balloon
};

/// The place of the probe that the stepper holds. The settings must have a probe.
ProbePlace probe_place(const ProbeSettings& settings, const ProbeSeat& seat);

/// A place as a pose: the origin and the axes of the probe.
Pose pose_of(const ProbePlace& place);

/// A free pose of the probe by the motions of a stepper, which are keys of [probe], and by the two that it lacks.
struct StepperMotions {
  double depth_mm = 0.0;
  double lift_mm = 0.0;
  double tilt_deg = 0.0;
  double roll_deg = 0.0;
  double aside_mm = 0.0;    ///< distance of the origin from the plane in which the stepper moves it; positive: left
  double turned_deg = 0.0;  ///< angle of the axis to this plane; positive: the end of the probe goes left
};

/// The inverse of probe_place(): with aside_mm = turned_deg = 0, probe_place() of these motions has this pose.
/// @param pose LPS; its local axes are those of ProbePlace::axes
StepperMotions stepper_motions(const Pose& pose, const ProbeSeat& seat);

}  // namespace stylet
