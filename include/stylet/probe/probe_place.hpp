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

}  // namespace stylet
