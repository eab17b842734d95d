// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant_probe.hpp"

#include <fmt/format.h>

#include <set>

namespace stylet {

namespace {

/// "3 seeds of the needles C3 and d3": seeds with a property.
struct NamedSeeds {
  int count = 0;
  std::set<std::string> needles;

  void add(const std::string& needle) {
    ++count;
    needles.insert(needle);
  }
  [[nodiscard]] std::string text() const {
    std::string names;
    std::size_t k = 0;
    for (const std::string& name : needles) {
      names += (k == 0 ? "" : k + 1 == needles.size() ? " and " : ", ") + name;
      ++k;
    }
    return fmt::format("{} seed{} of needle{} {}", count, count == 1 ? "" : "s", needles.size() == 1 ? "" : "s", names);
  }
};

bool is_in_rectum(const Locator& locator, const Vec3& x) {
  const auto at = locator.find(x);
  if (!at) return false;
  const TetMesh& mesh = locator.mesh();
  const std::string& region =
      mesh.regions[static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(at->tet)])];
  return region == "rectum" || region == "rectal_lumen";
}

}  // namespace

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

std::vector<std::string> probe_harms(const ImplantProbe& probe, const ImplantHistory& history) {
  const Capsule surface = capsule_of(probe.report.place);
  NamedSeeds in_probe, in_rectum;
  for (const SeedHistory& seed : history.seeds) {
    if (seed.lost) continue;
    const std::string& needle = history.needles[seed.needle].name;
    const Vec3 under_probe = seed.rest_mm - seed.by(SeedCause::probe);
    if (surface.nearest(under_probe).mm < 0.0) {
      in_probe.add(needle);
    } else if (is_in_rectum(*probe.patient.locator, seed.rest_mm) &&
               !is_in_rectum(*probe.patient.locator, under_probe)) {
      in_rectum.add(needle);
    }
  }
  std::vector<std::string> harms;
  if (in_probe.count > 0) {
    harms.push_back(in_probe.text() +
                    " would come to rest in the probe, where no needle can go. Lower probe.lift_mm, or move the "
                    "needles.");
  }
  if (in_rectum.count > 0) {
    harms.push_back(in_rectum.text() +
                    " came to rest in the rectum, whose wall the probe had pushed to where the contours of the plan "
                    "have other tissue. Lower probe.lift_mm, or plan on contours with the probe in place.");
  }
  return harms;
}

}  // namespace stylet
