// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {

/// prepare() makes compliance available within this radius around the tip.
constexpr double kPrepare_mm = 6.0;
/// The radius is at most this fraction of the corridor's, so that a needle on its planned path needs no new compliance.
constexpr double kPrepareShare = 0.75;
/// A worker computes compliance this far ahead of the tip.
constexpr double kAhead_mm = 10.0;
constexpr int kNeedleSamples = 81;

/// The model's tissue with copies of its compliance, which share the model's data and can grow independently.
InsertionTissue tissue_of(const Model& model) {
  return {std::make_shared<ComplianceStore>(*model.store()),
          &model.locator(),
          model.laws(),
          model.inverse(),
          model.kernel() ? std::make_shared<MeshKernel>(*model.kernel()) : nullptr,
          model.spread()};
}

CouplingSettings with_needles(CouplingSettings settings, int needles) {
  settings.needles = std::max(1, needles);
  return settings;
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const Model> model, int needles)
    : model_(std::move(model)),
      insertion_(tissue_of(*model_), model_->make_needle(), with_needles(model_->coupling(), needles)),
      resting_(static_cast<std::size_t>(std::max(1, needles))) {
  // Reserve memory for the names of regions, so that step() does not allocate.
  std::size_t longest = 0;
  for (const std::string& region : model_->mesh().regions) longest = std::max(longest, region.size());
  for (Event& event : events_) event.region.reserve(longest);
  place(model_->insertions().front());
}

double Simulation::base_depth_mm(const Pose& base) const {
  const Vec3 rigid_tip = base.origin + insertion_.needle().length() * (base.rotation * Vec3::UnitZ());
  return (rigid_tip - entry_).dot(direction_);
}

void Simulation::place(const Pose& base, const Vec3& entry, const Vec3& direction) {
  entry_ = entry;
  direction_ = direction.normalized();
  turns_ = {};
  slipping_ = true;
  event_count_ = 0;
  insertion_.place_guide(entry_ - model_->scenario().grid.distance_mm * direction_, direction_);
  insertion_.place(base);
  Step placed;
  placed.time_s = step_.time_s;
  placed.base = base;
  placed.base_depth_mm = base_depth_mm(base);
  placed.tip_mm = insertion_.needle().point(insertion_.needle().length());
  step_ = placed;
}

Result<> Simulation::take_up(int needle) {
  while (insertion_.needles() <= needle && needle < static_cast<int>(resting_.size())) {
    if (const auto added = insertion_.add_needle(model_->make_needle()); !added) return added.error();
  }
  const int before = insertion_.held();
  if (needle == before) return Ok{};
  if (auto taken = insertion_.take_up(needle); !taken) return taken;
  resting_[static_cast<std::size_t>(before)] = {entry_, direction_, step_, turns_, slipping_};
  const Resting& now = resting_[static_cast<std::size_t>(needle)];
  const double time_s = step_.time_s;
  entry_ = now.entry;
  direction_ = now.direction;
  step_ = now.step;
  step_.time_s = time_s;
  turns_ = now.turns;
  slipping_ = now.slipping;
  event_count_ = 0;
  return Ok{};
}

ComplianceSupply::Settings Simulation::supply_settings() const {
  return {.radius_mm = std::min(kPrepare_mm, kPrepareShare * model_->corridor_mm()),
          .ahead_mm = kAhead_mm,
          .spare_nodes = model_->coupling().spare_nodes};
}

void Simulation::start_clock() {
  time_ns_ = 0;
  step_.time_s = 0.0;
}

void Simulation::prepare() { insertion_.prepare(std::min(kPrepare_mm, kPrepareShare * model_->corridor_mm())); }

void Simulation::add_event(EventKind kind, double force_N, int region) {
  if (event_count_ == static_cast<int>(events_.size())) return;
  Event& event = events_[static_cast<std::size_t>(event_count_++)];
  event.kind = kind;
  event.time_s = step_.time_s;
  event.depth_mm = step_.base_depth_mm;
  event.force_N = force_N;
  event.region.clear();
  if (region >= 0) event.region.assign(model_->mesh().regions[static_cast<std::size_t>(region)]);
}

/// Adds an event if the base has turned round. The event has the time of the turn, not the time of its detection.
void Simulation::notice_turn(double advance_mm, bool in_tissue) {
  const auto turned = turns_.follow(advance_mm, {step_.time_s, step_.base_depth_mm, step_.force_axial_N, in_tissue});
  if (!turned) return;
  slipping_ = false;
  if (!turns_.retracting() || !turned->in_tissue) return;
  add_event(EventKind::retraction_start, turned->force_N, -1);
  Event& event = events_[static_cast<std::size_t>(event_count_ - 1)];
  event.time_s = turned->time_s;
  event.depth_mm = turned->depth_mm;
}

const Step& Simulation::step(const Pose& base, double dt) {
  const double force_before = step_.force_axial_N;
  const double depth_before = step_.base_depth_mm;
  const Vec3 axis = base.rotation * Vec3::UnitZ();
  const double advance = (base.origin - step_.base.origin).dot(axis);
  const Step taken = insertion_.step(base, dt);
  event_count_ = 0;
  if ((taken.flags & Step::invalid_input) != 0) {
    step_.flags = Step::invalid_input;
    return step_;
  }
  step_ = taken;
  time_ns_ += std::llround(dt * 1e9);
  step_.time_s = static_cast<double>(time_ns_) / 1e9;
  step_.dt_s = dt;
  step_.base_depth_mm = base_depth_mm(base);
  // Components of the hand's force: axial, lateral (towards the patient's left), sagittal = axial × lateral.
  Vec3 lateral = Vec3::UnitX() - axis.x() * axis;
  if (lateral.norm() < 1e-3) lateral = Vec3::UnitY() - axis.y() * axis;
  lateral.normalize();
  step_.force_axial_N = step_.hand_force_N.dot(axis);
  step_.force_lateral_N = step_.hand_force_N.dot(lateral);
  step_.force_sagittal_N = step_.hand_force_N.dot(axis.cross(lateral));

  notice_turn(advance, step_.contacts > 0 || step_.tip_state == TipState::in_track);
  for (const InsertionEvent& event : insertion_.events()) {
    // The force of a puncture is the force that broke the surface; at the end of the step it is lower.
    const int before = event_count_;
    add_event(event.kind, std::isfinite(event.force_N) ? event.force_N : step_.force_axial_N, event.region);
    if (event.passed == 1.0 || event_count_ == before) continue;
    Event& within = events_[static_cast<std::size_t>(event_count_ - 1)];
    within.time_s -= (1.0 - event.passed) * dt;
    within.depth_mm = std::lerp(depth_before, step_.base_depth_mm, event.passed);
  }
  // Right after the turn the tissue springs back along the shaft, so contacts still slide inwards; then they stick and
  // the tissue moves out with the shaft. Only then does sliding outwards count as the start of slip.
  if (!slipping_ && turns_.retracting() && step_.sliding_out_share > 0.5 && step_.force_axial_N < 0.0) {
    slipping_ = true;
    add_event(EventKind::slip_start, std::min(force_before, step_.force_axial_N), -1);
  }
  return step_;
}

Frame Simulation::frame(const std::string& label, Balance* balance) const {
  Frame frame;
  frame.time_s = step_.time_s;
  frame.base_depth_mm = step_.base_depth_mm;
  frame.label = label;
  ContactCompliance::Moment moment = insertion_.moment();
  frame.displacement = std::move(moment.displacement);
  if (balance != nullptr) *balance = balance_of(moment.nodes);
  const Needle& needle = insertion_.needle();
  for (int i = 0; i < kNeedleSamples; ++i)
    frame.needle.push_back(needle.point(needle.length() * i / (kNeedleSamples - 1)));
  for (const ContactState& contact : insertion_.contacts()) {
    frame.contacts.push_back({contact.position, contact.force, contact.s, contact.sticking, contact.tip});
  }
  return frame;
}

Simulation::Balance Simulation::balance_of(const ContactCompliance::Nodes& nodes) const {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  for (std::size_t k = 0; k < nodes.position.size(); ++k) {
    const auto node = static_cast<Index>(k);
    const Vec3 on_node = nodes.load.segment<3>(3 * node);
    // A contact's force on a held node is carried by the support and deforms nothing.
    Vec3 f = nodes.support.segment<3>(3 * node);
    const bool fixed = node < model_->mesh().node_count() && model_->tissue().is_fixed(node);
    if (!fixed) f += on_node;
    force += f;
    torque += (nodes.position[k] - entry_).cross(f);
  }
  return {force.norm(), torque.norm() / 100.0};
}

}  // namespace stylet
