// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/tissue_probe.hpp"

#include <algorithm>

namespace stylet {

namespace {

constexpr double kExactDrop_mm = 0.005;
constexpr int kMostDropIterations = 60;

std::optional<Insertion::PointDisplacement> displacement_of(Simulation& simulation, const Vec3& x) {
  const auto at = simulation.model().locator().find(x);
  if (!at) return std::nullopt;
  return simulation.displacement_at(*at, x);
}

}  // namespace

std::uint32_t TissueProbe::order_drop(double beyond_tip_mm) {
  const double behind = -beyond_tip_mm;
  return order_train(std::span(&behind, 1), beyond_tip_mm);
}

std::uint32_t TissueProbe::order_train(std::span<const double> behind_tip_mm, double half_length_mm) {
  ++wanted_.number;
  wanted_.seeds = std::min(behind_tip_mm.size(), kTrain);
  for (std::size_t k = 0; k < wanted_.seeds; ++k) wanted_.beyond_tip_mm[k] = -behind_tip_mm[k];
  wanted_.half_length_mm = half_length_mm;
  order_.write(wanted_);
  return wanted_.number;
}

std::uint32_t TissueProbe::watch(std::span<const Vec3> points) {
  ++wanted_.version;
  wanted_.count = std::min(points.size(), kPoints);
  for (std::size_t k = 0; k < wanted_.count; ++k) wanted_.points[k] = plain(points[k]);
  order_.write(wanted_);
  return wanted_.version;
}

/// Notes where the seeds of the train are.
void TissueProbe::begin_train(const Simulation& simulation) {
  const TissueOrder& order = order_.value();
  const Step& step = simulation.last_step();
  const Needle& needle = simulation.insertion().needle();
  const double length = needle.length();
  const bool in_tissue =
      step.inserted_mm > 0.0 && step.tip_state != TipState::air && step.tip_state != TipState::exited;
  search_.reset();
  left_ = in_tissue ? 0 : order.seeds;
  now_.order = order.number;
  now_.began_at_mm = step.base_depth_mm;
  now_.drop_count = order.seeds;
  for (std::size_t k = 0; k < order.seeds; ++k) {
    const double beyond = order.beyond_tip_mm[k];
    const double arc = std::clamp(length + beyond, 0.0, length);
    const Vec3 axis = needle.tangent(arc);
    ProbedDrop& drop = now_.drops[k];
    drop = {};
    drop.tip_in_tissue = in_tissue;
    drop.place = plain(needle.point(arc) + (length + beyond - arc) * axis);
    drop.straight = plain(step.base.origin + (length + beyond) * (step.base.rotation * Vec3::UnitZ()));
    drop.axis = plain(axis);
    drop.rest = drop.place;
    drop.is_done = !in_tissue;
  }
}

/// Begins the search for the next seed of the train if the tip has been drawn back beyond its end.
void TissueProbe::leave_next(const Simulation& simulation) {
  constexpr double rounding_mm = 1e-9;
  if (left_ >= now_.drop_count) return;
  ProbedDrop& drop = now_.drops[left_];
  const Needle& needle = simulation.insertion().needle();
  const double beyond = (vec3(drop.place) - needle.point(needle.length())).dot(vec3(drop.axis));
  if (beyond < order_.value().half_length_mm - rounding_mm) return;
  const Step& step = simulation.last_step();
  drop.base_depth_mm = step.base_depth_mm;
  drop.time_s = step.time_s;
  search_.emplace(vec3(drop.place), kExactDrop_mm, kMostDropIterations);
}

void TissueProbe::search(Simulation& simulation) {
  for (int k = 0; k < kEachStep && !search_->is_done(); ++k) search_->add(displacement_of(simulation, search_->x()));
  if (!search_->is_done()) return;
  ProbedDrop& drop = now_.drops[left_++];
  drop.is_done = true;
  if (const auto& found = search_->found()) {
    drop.found = true;
    // The distance from the place to the nearest point counts as motion of the tissue.
    drop.rest = plain(vec3(drop.place) - found->moved.whole);
    drop.lasting = plain(found->moved.lasting);
  }
  search_.reset();
}

void TissueProbe::look(Simulation& simulation) {
  for (int k = 0; k < kEachStep; ++k) {
    next_ = (next_ + 1) % now_.count;
    const Vec3 x = vec3(order_.value().points[next_]);
    const auto u = displacement_of(simulation, x);
    now_.is_known[next_] = u.has_value();
    if (u) now_.now[next_] = plain(x + u->whole);
  }
}

void TissueProbe::serve(Simulation& simulation) noexcept {
  order_.fetch();
  const TissueOrder& order = order_.value();
  bool is_new = false;
  if (order.version != now_.version) {
    now_.version = order.version;
    now_.count = order.count;
    now_.is_known.fill(false);
    next_ = 0;
    is_new = true;
  }
  if (order.number != now_.order) {
    begin_train(simulation);
    is_new = true;
  }
  if (!search_) leave_next(simulation);
  if (search_) {
    search(simulation);
    is_new = is_new || !search_;
  } else if (now_.count > 0 && ++turn_ % kWatchEvery == 0) {
    look(simulation);
    is_new = true;
  }
  if (is_new) answer_.write(now_);
}

}  // namespace stylet
