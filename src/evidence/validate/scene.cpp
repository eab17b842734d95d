// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

/// Pose of the base at which a straight needle reaches `depth_mm` beyond the entry.
Pose pose_at(const PlannedInsertion& insertion, double length_mm, double depth_mm, const Vec3& sideways) {
  return pose_along(insertion.entry + (depth_mm - length_mm) * insertion.direction + sideways, insertion.direction);
}

}  // namespace

Block Block::of_one_tissue(TissuePreset preset) {
  Block block;
  block.gland_radius_mm = 0.0;
  block.scenario.tissue_model.preset = preset;
  return block;
}

TissueParameters& Block::tissue(const std::string& region) {
  return scenario.tissue.try_emplace(region, tissue_of(scenario, region)).first->second;
}

TetMesh Block::mesh() const {
  const Vec3 cell = (hi - lo).cwiseQuotient(Vec3(cells[0], cells[1], cells[2]));
  const Vec3 outer_lo = lo - Vec3(cell.x(), cell.y(), 0.0);
  TetMesh mesh = box_mesh(outer_lo, hi + cell, {cells[0] + 2, cells[1] + 2, cells[2] + 1}, jitter);
  std::vector<std::string> names{"body", "wall"};
  if (gland_radius_mm > 0.0) names.emplace_back("prostate");
  assign_regions(mesh, names, [&](const Vec3& x) {
    if ((x.array() < lo.array()).any() || (x.array() > hi.array()).any()) return 1;
    return gland_radius_mm > 0.0 && (x - gland_centre).norm() < gland_radius_mm ? 2 : 0;
  });
  for (Vec3& x : mesh.nodes) x = placing * x;
  if (placing.linear().determinant() < 0.0) {
    for (auto& tet : mesh.tets) std::swap(tet[0], tet[1]);
  }
  return mesh;
}

Result<std::shared_ptr<const Model>> Block::compile(const std::vector<std::array<double, 3>>& more) const {
  Scenario complete = scenario;
  complete.patient.source = "block";
  complete.fixed.regions = {"wall"};
  complete.fixed.outer = OuterSupport::none;
  complete.output.frames_per_s = 0.0;
  std::vector<std::array<double, 3>> entries{entry_mm};
  entries.insert(entries.end(), more.begin(), more.end());
  const Vec3 along = placing.linear() * Vec3(direction.data());
  for (const auto& entry : entries) {
    const Vec3 at = placing * Vec3(entry.data());
    InsertionPlan plan;
    plan.entry_mm = {at.x(), at.y(), at.z()};
    plan.direction = {along.x(), along.y(), along.z()};
    plan.depth_mm = depth_mm;
    complete.insertions.push_back(plan);
  }
  return Model::compile(complete, mesh(), "block");
}

Drive::Drive(std::shared_ptr<const Model> model, double start_mm, std::size_t insertion)
    : model_(std::move(model)), simulation_(model_) {
  aim(insertion, start_mm);
}

void Drive::aim(std::size_t insertion, double start_mm) {
  number_ = insertion;
  depth_mm_ = start_mm;
  sideways_.setZero();
  base_ = pose();
  const PlannedInsertion& plan = model_->insertions()[number_];
  simulation_.place(base_, plan.entry, plan.direction);
}

Pose Drive::pose() const {
  return pose_at(model_->insertions()[number_], model_->scenario().needle.length_mm, depth_mm_, sideways_);
}

void Drive::go(double to_mm, double speed_mm_per_s, double dt_s) {
  const double from = depth_mm_;
  const double way = to_mm - from;
  const auto count = std::max<long>(1, std::lround(std::abs(way) / (speed_mm_per_s * dt_s)));
  for (long k = 1; k <= count; ++k) {
    depth_mm_ = from + way * static_cast<double>(k) / static_cast<double>(count);
    step(dt_s);
  }
}

void Drive::wait(double seconds, double dt_s) {
  for (long k = 0; k < std::lround(seconds / dt_s); ++k) step(dt_s);
}

void Drive::shift(const Vec3& sideways, double dt_s) {
  sideways_ = sideways;
  step(dt_s);
}

void Drive::step(double dt_s) {
  const Pose next = pose();
  simulation_.prepare();
  DriveStep made;
  made.record = simulation_.step(next, dt_s);
  const Step& report = simulation_.last_step();
  made.hand_force = report.hand_force_N;
  const bool tip = made.record.tip_state == TipState::pressing || made.record.tip_state == TipState::cutting ||
                   made.record.tip_state == TipState::bone;
  made.shaft_contacts = report.contacts - (tip ? 1 : 0);
  const Vec3 force_before = steps_.empty() ? Vec3(Vec3::Zero()) : last().hand_force;
  made.work_Nmm =
      (steps_.empty() ? 0.0 : last().work_Nmm) + 0.5 * (made.hand_force + force_before).dot(next.origin - base_.origin);
  base_ = next;
  flags_ |= report.flags;
  for (const Event& event : simulation_.new_events()) events_.push_back(event);
  steps_.push_back(made);
}

const Event* Drive::event(EventKind kind) const {
  const auto found = std::find_if(events_.begin(), events_.end(), [&](const Event& e) { return e.kind == kind; });
  return found != events_.end() ? &*found : nullptr;
}

double Drive::peak_N() const {
  double peak = 0.0;
  for (const DriveStep& s : steps_) peak = std::max(peak, std::abs(s.record.force_axial_N));
  return peak;
}

Curve curve_of(const Drive& drive, const std::string& label, double Step::*over, double Step::*quantity) {
  Curve curve{.label = label};
  for (const DriveStep& s : drive.steps()) curve.add(s.record.*over, s.record.*quantity);
  return curve;
}

}  // namespace stylet::validate
