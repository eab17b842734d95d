// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/implant/implant.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "stylet/sim/held_tissue.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// The probe that presses while an implant is carried out, and is taken out afterwards.
struct ImplantProbe {
  HeldTissue patient;
  ProbeReport report;
  Eigen::Matrix3Xf in;   ///< [mm] LPS (3 × nodes) displacement of the nodes by the probe, relative to the contours
  Eigen::Matrix3Xf out;  ///< the same once the probe is out; not zero where the contours were drawn with it in place
};

/// The probe of a scenario in its patient; empty if the scenario has none.
/// @param where name of the patient in messages
/// Errors: those of hold_tissue() and of PatientProbe::prepare().
Result<std::optional<ImplantProbe>> implant_probe(const Scenario& scenario, const TetMesh& mesh,
                                                  const std::string& where, const Progress& progress);

/// Sentences about seeds that the probe and its wall leave no room for: those in the probe, and those in the rectum
/// only because the probe has pushed its wall towards their needles.
/// @param history of an implant with this probe
std::vector<std::string> probe_harms(const ImplantProbe& probe, const ImplantHistory& history);

}  // namespace stylet
