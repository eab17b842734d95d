// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic_run.hpp"

#include "stylet/geom/box_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet::testing {

namespace {

// ---- anatomy: ellipsoids in a box, feet at z = 0 -------------------------------------------------------------------

struct Ellipsoid {
  const char* name;
  Vec3 centre, radii;
  /// Approximate distance to the surface [mm], negative inside.
  [[nodiscard]] double level(const Vec3& x) const {
    return ((x - centre).cwiseQuotient(radii).norm() - 1) * radii.minCoeff();
  }
};

const Vec3 kLow(-60, -50, 0), kHigh(60, 50, 120);

/// The organs; the first that contains a point determines its region, and points outside of all are in the body.
const std::array<Ellipsoid, 5>& organs() {
  static const std::array<Ellipsoid, 5> all{{{"prostate", {0, 0, 62}, {25, 18, 20}},
                                             {"bladder", {0, -9, 100}, {30, 23, 19}},
                                             {"rectum", {0, 33, 75}, {15, 13, 40}},
                                             {"pubic_arch", {0, -40, 60}, {34, 9, 13}},
                                             {"seminal_vesicles", {0, 20, 92}, {19, 7, 8}}}};
  return all;
}

int organ_at(const Vec3& x) {
  for (std::size_t k = 0; k < organs().size(); ++k) {
    if (organs()[k].level(x) < 0) return static_cast<int>(k) + 1;
  }
  return 0;
}

/// Moves nodes that are close to an organ's surface onto it, unless a tetrahedron would become flat.
void fit_to_organs(TetMesh& mesh, double reach) {
  const std::vector<Vec3> grid = mesh.nodes;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const Vec3& x = grid[n];
    if ((x - kLow).minCoeff() < 1e-9 || (kHigh - x).minCoeff() < 1e-9) continue;
    const auto nearest = std::min_element(organs().begin(), organs().end(), [&](const auto& a, const auto& b) {
      return std::abs(a.level(x)) < std::abs(b.level(x));
    });
    const double scaled = (x - nearest->centre).cwiseQuotient(nearest->radii).norm();
    const Vec3 target = nearest->centre + (x - nearest->centre) / scaled;
    if ((target - x).norm() < reach) mesh.nodes[n] = target;
  }
  for (bool moved = true; moved;) {
    moved = false;
    for (Index t = 0; t < mesh.tet_count(); ++t) {
      if (tet_volume(mesh, t) > 0.1 * std::pow(reach, 3)) continue;
      for (const Index node : mesh.tets[static_cast<std::size_t>(t)]) {
        const auto n = static_cast<std::size_t>(node);
        moved = moved || mesh.nodes[n] != grid[n];
        mesh.nodes[n] = grid[n];
      }
    }
  }
}

TetMesh anatomy(const std::array<int, 3>& cells) {
  TetMesh mesh = box_mesh(kLow, kHigh, cells);
  fit_to_organs(mesh, 0.4 * (kHigh.z() - kLow.z()) / cells[2]);
  std::vector<std::string> names{"body"};
  for (const Ellipsoid& organ : organs()) names.emplace_back(organ.name);
  assign_regions(mesh, names, organ_at);
  return mesh;
}

// ---- motion, forces and deformation --------------------------------------------------------------------------------

constexpr double kSpeed = 20, kStart = -6, kDeepest = 76, kHold = 0.4;   // mm/s, mm, mm, s
constexpr double kSkin = 0, kPuncture = 7, kGland = 41, kGlandCut = 46;  // depths [mm]
constexpr double kStick = 4;                                             // retraction before slip [mm]
constexpr double kInsertion = (kDeepest - kStart) / kSpeed;
constexpr double kRetractionStart = kInsertion + kHold;
constexpr double kEnd = kRetractionStart + kInsertion;
constexpr double kLength = 200;
const Vec3 kEntry(9, 6, 0);

double depth_at(double time) {
  if (time < kInsertion) return kStart + kSpeed * time;
  if (time < kRetractionStart) return kDeepest;
  return std::max(kStart, kDeepest - kSpeed * (time - kRetractionStart));
}

double inserting_force(double depth) {
  if (depth < kSkin) return 0;
  if (depth < kPuncture) return 1.1 * std::pow(depth / kPuncture, 1.6);
  double force = 0.30 + 0.013 * (depth - kPuncture);
  if (depth > kGland && depth < kGlandCut) force += 0.65 * std::pow((depth - kGland) / (kGlandCut - kGland), 1.4);
  if (depth >= kGlandCut) force += 0.22 + 0.008 * (depth - kGlandCut);
  return force;
}

double axial_force(double time) {
  const double depth = depth_at(time);
  if (time < kRetractionStart) return inserting_force(depth);
  const double back = kDeepest - depth, top = inserting_force(kDeepest);
  const double slipping = -0.0125 * std::max(0.0, depth);
  if (back > kStick) return slipping;
  const double turn = back / kStick;
  return top + (-0.0125 * (kDeepest - kStick) - top) * turn;
}

/// Largest displacement by which the tissue is dragged along [mm].
double drag_at(double time) { return 4.2 * axial_force(time) / inserting_force(kDeepest); }

VecX displacement_at(const TetMesh& mesh, double time) {
  const double depth = depth_at(time), drag = drag_at(time);
  VecX u = VecX::Zero(3 * mesh.node_count());
  if (depth <= 0) return u;
  for (Index n = 0; n < mesh.node_count(); ++n) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(n)];
    const double aside = (x - kEntry).head<2>().norm();
    const double wall = std::clamp(std::min({60 - std::abs(x.x()), 50 - std::abs(x.y()), 120 - x.z()}) / 25, 0.0, 1.0);
    const double along = std::exp(-std::pow(std::max(0.0, x.z() - depth) / 22, 2)) * std::min(1.0, (15 + x.z()) / 30);
    const double share = std::exp(-std::pow(aside / 26, 2)) * wall * along;
    u.segment<3>(3 * n) = share * drag * Vec3(0.08, -0.18, 1.0);
  }
  return u;
}

/// A point of the needle's centreline, which deviates from a straight line by a cubic in the inserted part.
Vec3 needle_point(double depth, double s) {
  const double z = depth - kLength + s;
  const double inside = std::max(0.0, z) / kDeepest;
  return kEntry + Vec3(2.4 * inside * inside * inside, -1.1 * inside * inside, z);
}

TipState tip_state(double time, double depth) {
  if (depth <= 0) return TipState::air;
  if (time >= kRetractionStart) return TipState::in_track;
  if (depth < kPuncture || (depth > kGland && depth < kGlandCut)) return TipState::pressing;
  return time < kInsertion ? TipState::cutting : TipState::pressing;
}

Step step_at(double time, int number) {
  Step s;
  s.time_s = time;
  s.base_depth_mm = depth_at(time);
  s.force_axial_N = axial_force(time);
  const double inside = std::clamp(s.base_depth_mm / kDeepest, 0.0, 1.0);
  s.force_sagittal_N = 0.16 * inside * inside * std::cos(3 * time);
  s.force_lateral_N = -0.11 * inside * inside + 0.02 * std::sin(5 * time) * inside;
  s.torque_Nmm = Vec3(s.force_sagittal_N, -s.force_lateral_N, 0) * kLength;
  s.tip_mm = needle_point(s.base_depth_mm, kLength);
  s.tip_state = tip_state(time, s.base_depth_mm);
  s.contacts = s.base_depth_mm <= 0 ? 0 : 1 + static_cast<int>(s.base_depth_mm / 5);
  const bool stuck = time >= kInsertion && kDeepest - s.base_depth_mm < kStick;
  s.sticking = stuck ? s.contacts : 0;
  s.iterations = 2 + number % 3;
  s.flags = number % 97 == 13 ? 1U << (number % 7) : 0U;
  s.step_us = 180 + 2.5 * s.contacts + 12 * std::abs(std::sin(0.7 * number)) + (number % 97 == 13 ? 210 : 0);
  return s;
}

Frame frame_at(const TetMesh& mesh, double time, std::string label) {
  Frame f;
  f.time_s = time;
  f.base_depth_mm = depth_at(time);
  f.label = std::move(label);
  f.displacement = displacement_at(mesh, time);
  for (int k = 0; k <= 80; ++k) f.needle.push_back(needle_point(f.base_depth_mm, kLength * k / 80));
  const bool stuck = time >= kInsertion && kDeepest - f.base_depth_mm < kStick;
  for (double z = f.base_depth_mm; z > 0; z -= 5) {
    ContactView c;
    c.s = kLength - (f.base_depth_mm - z);
    c.position = needle_point(f.base_depth_mm, c.s);
    c.force = Vec3(0, 0, axial_force(time) / (1 + f.base_depth_mm / 5));
    c.sticking = stuck || z < 20;
    c.tip = z == f.base_depth_mm;
    f.contacts.push_back(c);
  }
  return f;
}

std::vector<Event> events() {
  const auto inward = [](double depth) { return (depth - kStart) / kSpeed; };
  const double slip = kRetractionStart + kStick / kSpeed;
  const double out = kRetractionStart + kDeepest / kSpeed;
  const auto at = [](EventKind kind, double time, const char* region) {
    return Event{kind, time, depth_at(time), axial_force(time), region};
  };
  return {at(EventKind::skin_contact, inward(kSkin), "skin"),
          at(EventKind::puncture, inward(kPuncture) - 1e-6, "skin"),
          at(EventKind::region_entered, inward(kPuncture), "body"),
          at(EventKind::puncture, inward(kGlandCut) - 1e-6, "prostate"),
          at(EventKind::region_entered, inward(kGlandCut), "prostate"),
          at(EventKind::retraction_start, kRetractionStart, ""),
          at(EventKind::slip_start, slip, ""),
          at(EventKind::withdrawn, out, "")};
}

RunInfo run_info() {
  RunInfo info;
  info.version = "0.2.0";
  info.scenario_name = "synthetic patient, hole D4";
  info.scenario_text = "# made-up run for the tests\n[needle]\nlength_mm = 200.0\n";
  info.parameters = {
      {"tissue.prostate.young_kPa", "40", "kPa", "default: Krouskop et al. 1998"},
      {"tissue.prostate.poisson", "0.45", "1", "scenario"},
      {"tissue.body.young_kPa", "15", "kPa", "default: Gefen & Haberman 2007"},
      {"tissue.body.friction_coulomb_N_per_m", "11", "N/m", "default: Okamura et al. 2004"},
      {"needle.outer_diameter_mm", "1.27", "mm", "scenario"},
      {"insertion.speed_mm_per_s", "20", "mm/s", "scenario"},
  };
  info.supports = {"412 nodes of the pubic arch are held.",
                   "The outer faces of the body are held, except the perineal face."};
  info.warnings = {"Strain near the tip exceeds 20 %: beyond the validity of linear elasticity."};
  info.method = "node addition, rule interior, coupled solver";
  info.needle_diameter_mm = 1.27;
  info.needle_length_mm = kLength;
  info.target_regions = {1};
  info.entry_mm = kEntry;
  info.direction = Vec3::UnitZ();
  return info;
}

Summary summarise(const SyntheticRun& run) {
  Summary s;
  s.version = run.info.version;
  s.scenario = run.info.scenario_name;
  s.nodes = run.mesh.node_count();
  s.tets = run.mesh.tet_count();
  s.steps = static_cast<Index>(run.steps.size());
  for (const Step& step : run.steps) {
    s.peak_axial_N = std::max(s.peak_axial_N, std::abs(step.force_axial_N));
    s.peak_sagittal_N = std::max(s.peak_sagittal_N, std::abs(step.force_sagittal_N));
    s.peak_lateral_N = std::max(s.peak_lateral_N, std::abs(step.force_lateral_N));
    s.step_us_max = std::max(s.step_us_max, step.step_us);
    s.contacts_max = std::max(s.contacts_max, step.contacts);
  }
  s.capacity = {{s.contacts_max, 96}, {12, 1500}, {1, 64}, {3, 16}};
  s.events = events();
  s.tip_deflection_mm = 2.64;
  s.tip_error_mm = {0.4, -0.3, -2.1};
  s.target_shift_centroid_mm = {0.21, -0.48, 2.66};
  s.target_shift_max_mm = 3.94;
  s.target_shifts = {{s.target_shift_centroid_mm, s.target_shift_max_mm}};
  GlandMotion gland;
  gland.shift_at_break_mm = {0.12, -0.31, 1.84};
  gland.shift_max_mm = {0.22, -0.5, 2.71};
  gland.shift_in_place_mm = s.target_shift_centroid_mm;
  gland.shift_residual_mm = Vec3::Zero();
  gland.rotation_deg = {1.25, -0.5, 0.25};
  gland.base_mm = {0.1, -0.3, 2.2};
  gland.mid_mm = {0.2, -0.5, 2.8};
  gland.apex_mm = {0.3, -0.7, 3.1};
  gland.volume_change_percent = -0.4;
  s.gland = gland;
  s.gland_motions = {gland};
  for (const Step& step : run.steps) {
    const double in = std::max(0.0, step.base_depth_mm) / 76.0;
    s.gland_path.push_back({step.time_s, step.base_depth_mm, in * gland.shift_max_mm, in * gland.rotation_deg});
  }
  s.residual_force_balance = 3.1e-13;
  s.residual_torque_balance = 4.7e-13;
  s.step_us_p50 = 214;
  s.step_us_p99 = 431;
  s.step_us_p999 = 440;
  s.warnings = run.info.warnings;
  return s;
}

}  // namespace

SyntheticRun synthetic_run(const SyntheticOptions& options) {
  SyntheticRun run;
  run.info = run_info();
  run.mesh = anatomy(options.cells);
  const int steps = static_cast<int>(std::ceil(kEnd / options.step_s));
  for (int k = 0; k <= steps; ++k) run.steps.push_back(step_at(k * options.step_s, k));
  std::vector<std::pair<double, std::string>> moments{{0, "before"}, {kInsertion, "deepest"}, {kEnd, "after"}};
  for (const Event& e : events()) moments.emplace_back(e.time_s, to_string(e.kind));
  for (int k = 1; k <= options.frames; ++k) moments.emplace_back(kEnd * k / (options.frames + 1), "");
  std::sort(moments.begin(), moments.end());
  for (const auto& [time, label] : moments) run.frames.push_back(frame_at(run.mesh, time, label));
  run.summary = summarise(run);
  return run;
}

HoleMap synthetic_map() {
  const TemplateGrid grid;
  HoleMap map;
  map.columns = grid.columns;
  map.rows = grid.rows;
  map.planned = "e3.5";
  for (auto row = grid.rows.rbegin(); row != grid.rows.rend(); ++row) {
    for (const std::string& column : grid.columns) {
      const std::string name = column + *row;
      const auto offset = *grid.offset_mm(name);
      const double distance = std::hypot(offset[0], offset[1]);
      if (distance > 23 && name != "D1" && name != "D7") {
        ++map.missing;
        continue;
      }
      HoleRow hole;
      hole.hole = name;
      hole.left_mm = offset[0];
      hole.anterior_mm = offset[1];
      if (name == "D1") {
        hole.failed = "the target's far end lies 210 mm deep, the needle is 200 mm long";
      } else {
        hole.depth_mm = 80 - 0.4 * distance;
        hole.in_target_mm = 40 - distance;
        hole.clearance_mm = {std::max(0.0, 26 - distance - 0.5 * offset[1]), std::max(0.0, distance - 4), std::nullopt};
      }
      if (name != "D1" && name != "D7") {
        hole.prediction = Prediction{Vec3(0.1, 0.2, 2.5 - 0.05 * distance),
                                     Vec3(0.1, 0.3, 3 - 0.06 * distance),
                                     Vec3(0.3, 0.1, -8 - 0.2 * distance),
                                     {},
                                     {}};
      }
      if (name == "D4") hole.prediction->remarks.push_back("The needle entered the urethra, at a depth of 27.0 mm.");
      map.holes.push_back(std::move(hole));
    }
  }
  return map;
}

HoleMap synthetic_map_beside_needles() {
  HoleMap map = synthetic_map();
  map.in_place = {"B4", "F4"};
  for (HoleRow& hole : map.holes) {
    if (!hole.prediction) continue;
    const Prediction& alone = *hole.prediction;
    hole.prediction->in_place = NeedlesInPlace{.holes = map.in_place,
                                               .shift_mm = Vec3(0, 0, 2),
                                               .shift_at_break_mm = Vec3(0.4 * *alone.shift_at_break_mm),
                                               .shift_max_mm = Vec3(0.5 * *alone.shift_max_mm),
                                               .tip_error_mm = Vec3(*alone.tip_error_mm + Vec3(0, 0, 2)),
                                               .remarks = {"Needle in place, hole B4: it scraped."}};
  }
  return map;
}

RunRecording recording_of(const SyntheticRun& run) { return {run.info, run.mesh, run.steps, run.frames, run.summary}; }

}  // namespace stylet::testing
