// SPDX-License-Identifier: GPL-3.0-or-later
#include "probe_text.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace {

Json components(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

Json say_probe(const ImagedPatient& patient, Console& console) {
  if (!patient.probe) return nullptr;
  const Scenario& scenario = patient.scenario;
  const ProbeReport report = report_probe(patient.probe->probe(), scenario.probe, creep_of(scenario));
  for (const ProbeFact& fact : probe_facts(report)) console.say(fmt::format("{}: {}", fact.name, fact.text));
  return {
      {"array_mm", components(report.place.origin_mm)},
      {"lift_mm", scenario.probe.lift_mm},
      {"tilt_deg", scenario.probe.tilt_deg},
      {"roll_deg", scenario.probe.roll_deg},
      {"force_N", components(report.press.force_N)},
      {"gland",
       {{"shift_mm", components(report.gland.shift_mm)}, {"change_percent", components(report.gland.change_percent)}}}};
}

}  // namespace stylet::cli
