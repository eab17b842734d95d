// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant_probe.hpp"

namespace stylet {

Result<std::optional<ImplantProbe>> implant_probe(const Scenario& scenario, const TetMesh& mesh,
                                                  const std::string& where, const Progress& progress) {
  if (scenario.probe.kind == ProbeKind::none) return std::optional<ImplantProbe>();
  Result<HeldTissue> held = hold_tissue(scenario, mesh, where, progress);
  if (!held) return held.error();
  Result<PatientProbe> probe =
      PatientProbe::prepare({*held->tissue, *held->topology, held->target}, scenario.probe, where, progress);
  if (!probe) return probe.error();
  ImplantProbe result{.patient = *held,
                      .report = report_probe(*probe, scenario.probe, creep_of(scenario)),
                      .in = Eigen::Matrix3Xf(3, mesh.node_count()),
                      .out = Eigen::Matrix3Xf(3, mesh.node_count())};
  probe->contact().displacement(result.in);
  probe->contact().release();
  probe->contact().displacement(result.out);
  return std::optional<ImplantProbe>(std::move(result));
}

}  // namespace stylet
