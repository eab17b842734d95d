// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/patient_probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// "3.2 mm to the left"; a value that rounds to 0 has no direction.
std::string way(double mm, const char* positive, const char* negative) {
  if (std::abs(mm) < 0.05) return fmt::format("0.0 mm to {}", positive);
  return fmt::format("{:.1f} mm to {}", std::abs(mm), mm > 0.0 ? positive : negative);
}

std::string place_in_words(const ProbeReport& report) {
  const ProbeSettings& s = report.settings;
  std::string text = fmt::format("{} probe, {:g} mm across{}; array at ({:.1f}, {:.1f}, {:.1f}) mm LPS",
                                 s.kind == ProbeKind::endfire ? "end-fire" : "biplane", s.diameter_mm,
                                 s.balloon_mm > 0.0 ? fmt::format(", in {:g} mm of water", s.balloon_mm) : "",
                                 report.place.origin_mm.x(), report.place.origin_mm.y(), report.place.origin_mm.z());
  text += fmt::format(", lifted by {:g} mm, tilted by {:g}°, rolled by {:g}°", s.lift_mm, s.tilt_deg, s.roll_deg);
  if (s.in_contours) text += "; the contours were drawn with it there, so it moves nothing";
  return text;
}

std::string force_in_words(const ProbeReport& report) {
  const Vec3& f = report.lasting_force_N;
  if (report.press.touching == 0) return "none, the probe does not touch the wall";
  return fmt::format(
      "{:.1f} N on the probe while it stays (left {:.1f}, posterior {:.1f}, superior {:.1f}); {:.1f} N while it is "
      "pushed in",
      f.norm(), f.x(), f.y(), f.z(), report.press.force_N.norm());
}

}  // namespace

Result<PatientProbe> PatientProbe::prepare(const Patient& patient, const ProbeSettings& settings,
                                           const std::string& where, const Progress& progress) {
  const TetMesh& mesh = patient.tissue.mesh();
  const auto seat = probe_seat(mesh, patient.gland_regions, where);
  if (!seat) return seat.error();
  const auto faces = rectal_wall(mesh, patient.topology, where);
  if (!faces) return faces.error();
  // The areas are those around a probe at the level of the gland, whatever its depth, so that the force is the same
  // function of the pose for every scenario.
  ProbeSettings rest;
  rest.diameter_mm = settings.diameter_mm;
  rest.balloon_mm = settings.balloon_mm;
  const ProbePlace middle = probe_place(rest, *seat);
  WallReach reach;
  reach.rest = capsule_of(middle);
  reach.finest = middle.axes.col(1);
  reach.lowest_mm = lowest_level_mm(mesh, *faces, reach.rest);
  reach.beyond_mm += std::max(0.0, settings.depth_mm.value_or(seat->gland_mm) - seat->gland_mm);
  std::vector<WallPoint> points = wall_points(patient.tissue, *faces, reach);
  if (points.empty())
    return input_error(where, "no part of its rectum is near the axis of the probe",
                       "Check the structure rectum, or set probe.kind = \"none\"");
  Result<WallCompliance> solved = WallCompliance::solve(patient.tissue, std::move(points), progress);
  if (!solved) return solved.error();
  auto wall = std::make_shared<const WallCompliance>(*std::move(solved));
  PatientProbe probe(*seat, ProbeContact(std::move(wall)), GlandMeasure(mesh, patient.topology, patient.gland_regions));
  if (settings.in_contours) probe.contact_.set_reference(capsule_of(probe.place(settings)));
  return probe;
}

Result<PatientProbe> PatientProbe::prepare(const Model& model, const std::string& where, const Progress& progress) {
  return prepare(Patient{model.tissue(), model.topology(), model.target_regions()}, model.scenario().probe, where,
                 progress);
}

GlandForm PatientProbe::gland() const {
  Eigen::Matrix3Xf u(3, wall().nodes.rows() / 3);
  contact_.displacement(u);
  return measure_.form(u);
}

ProbeReport report_probe(PatientProbe& probe, const ProbeSettings& settings, double creep) {
  ProbeReport report;
  report.settings = settings;
  report.place = probe.place(settings);
  report.press = probe.press(settings);
  report.lasting_force_N = report.press.force_N / creep;
  report.gland = probe.gland();
  report.wall_points = probe.wall().count();
  report.prepare_s = probe.wall().seconds;
  report.megabytes = probe.wall().megabytes();
  return report;
}

Result<ProbeReport> report_probe(const Model& model, const std::string& where, const Progress& progress) {
  auto probe = PatientProbe::prepare(model, where, progress);
  if (!probe) return probe.error();
  return report_probe(*probe, model.scenario().probe, creep_of(model.scenario()));
}

std::vector<ProbeFact> probe_facts(const ProbeReport& report) {
  const GlandForm& gland = report.gland;
  return {
      {"probe", place_in_words(report)},
      {"probe force", force_in_words(report)},
      {"gland under the probe",
       fmt::format("{:+.1f} % anterior-posterior, {:+.1f} % left-right, {:+.1f} % superior-inferior, {:+.1f} % in "
                   "volume; moved by {}, {}, {}",
                   gland.change_percent.y(), gland.change_percent.x(), gland.change_percent.z(), gland.volume_percent,
                   way(gland.shift_mm.x(), "the left", "the right"), way(gland.shift_mm.y(), "posterior", "anterior"),
                   way(gland.shift_mm.z(), "superior", "inferior"))},
      {"probe contact", fmt::format("{} of {} areas of the rectal wall, at most {:.3f} mm deep in the probe",
                                    report.press.touching, report.wall_points, report.press.penetration_mm)},
  };
}

}  // namespace stylet
