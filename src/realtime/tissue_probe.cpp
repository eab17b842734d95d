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
  ++wanted_.drop;
  wanted_.beyond_tip_mm = beyond_tip_mm;
  order_.write(wanted_);
  return wanted_.drop;
}

std::uint32_t TissueProbe::watch(std::span<const Vec3> points) {
  ++wanted_.version;
  wanted_.count = std::min(points.size(), kPoints);
  for (std::size_t k = 0; k < wanted_.count; ++k) wanted_.points[k] = plain(points[k]);
  order_.write(wanted_);
  return wanted_.version;
}

void TissueProbe::begin_drop(const Simulation& simulation) {
  const Step& step = simulation.last_step();
  const Needle& needle = simulation.insertion().needle();
  const double beyond = order_.value().beyond_tip_mm;
  const Vec3 axis = needle.tangent(needle.length());
  ProbedDrop& drop = now_.drop;
  drop = {};
  drop.number = order_.value().drop;
  drop.tip_in_tissue = step.inserted_mm > 0.0 && step.tip_state != TipState::air && step.tip_state != TipState::exited;
  drop.place = plain(needle.point(needle.length()) + beyond * axis);
  drop.straight = plain(step.base.origin + (needle.length() + beyond) * (step.base.rotation * Vec3::UnitZ()));
  drop.axis = plain(axis);
  drop.rest = drop.place;
  drop.base_depth_mm = step.base_depth_mm;
  drop.time_s = step.time_s;
  drop.is_done = !drop.tip_in_tissue;
  search_.reset();
  if (drop.tip_in_tissue) search_.emplace(vec3(drop.place), kExactDrop_mm, kMostDropIterations);
}

void TissueProbe::search(Simulation& simulation) {
  for (int k = 0; k < kEachStep && !search_->is_done(); ++k) search_->add(displacement_of(simulation, search_->x()));
  if (!search_->is_done()) return;
  ProbedDrop& drop = now_.drop;
  drop.is_done = true;
  if (const auto& found = search_->found()) {
    drop.found = true;
    // What the nearest point misses of the place counts as motion of the tissue.
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
  const Order& order = order_.value();
  bool is_new = false;
  if (order.version != now_.version) {
    now_.version = order.version;
    now_.count = order.count;
    now_.is_known.fill(false);
    next_ = 0;
    is_new = true;
  }
  if (order.drop != now_.drop.number) {
    begin_drop(simulation);
    is_new = true;
  }
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
