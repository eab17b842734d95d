// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/pressing_probe.hpp"

#include "stylet/geom/displaced.hpp"
#include "stylet/sim/held_tissue.hpp"

namespace stylet {

Result<PressingProbe> PressingProbe::prepare(std::shared_ptr<const Model> model, const std::string& where,
                                             const Progress& progress) {
  auto probe = PatientProbe::prepare(*model, where, progress);
  if (!probe) return probe.error();
  const Locator& locator = model->locator();
  return PressingProbe(std::move(model), locator, std::move(*probe));
}

Result<PressingProbe> PressingProbe::prepare(const Scenario& scenario, TetMesh mesh, const std::string& where,
                                             const Progress& progress) {
  auto held = hold_tissue(scenario, std::move(mesh), where, progress);
  if (!held) return held.error();
  auto patient = std::make_shared<const HeldTissue>(std::move(*held));
  auto probe =
      PatientProbe::prepare({*patient->tissue, *patient->topology, patient->target}, scenario.probe, where, progress);
  if (!probe) return probe.error();
  const Locator& locator = *patient->locator;
  return PressingProbe(std::move(patient), locator, std::move(*probe));
}

ProbePress PressingProbe::press(const ProbeSettings& settings, Moment& moment) {
  ProbePress press = probe_.press(settings);
  Eigen::Matrix3Xf moved(3, moment.displacement.cols());
  probe_.contact().displacement(moved);
  const auto move = [&](Vec3& x) {
    const auto at = locator_->find(undeformed(*locator_, moment.displacement, x));
    if (at) x += displacement_of(locator_->mesh(), moved, *at);
  };
  for (ShownNeedle& needle : moment.needles) {
    for (Vec3& x : needle.centreline_mm) move(x);
  }
  for (ShownTrack& track : moment.tracks) {
    for (Vec3& x : track.centreline_mm) move(x);
  }
  for (ShownSeed& seed : moment.seeds) move(seed.centre_mm);
  moment.displacement += moved;
  return press;
}

}  // namespace stylet
