// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_maker.hpp"

#include "stylet/core/survive.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <utility>

namespace stylet::serve {

namespace {

/// Lower priority than the loop, the pictures, the displacement field and a browser on this machine.
constexpr int kNiceOfMaps = 15;

/// Thrown to stop a simulation that nobody needs.
struct Unwanted {};

}  // namespace

MapMaker::MapMaker(const std::shared_ptr<const Model>& model, PlanOfHole plan_of)
    : plan_of_(std::move(plan_of)), needles_(*model), thread_([this, model = model]() mutable {
        (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()),
                          kNiceOfMaps);  // the threads that it starts inherit it
        survive(
            "the map of the holes", [&] { make(model); },
            [this](const Error& why) {
              const std::scoped_lock lock(mutex_);
              state_.why_not = why.what;
              changed_ = true;
            });
        model.reset();  // frees its compliance, which the map does not need
        while (const auto hole = next_hole()) predict(*hole);
        done_.store(true, std::memory_order_release);
      }) {}

MapMaker::~MapMaker() { give_up(); }

void MapMaker::want_predictions(bool wanted) {
  {
    const std::scoped_lock lock(mutex_);
    wanted_ = wanted;
    state_.predicting = wanted && state_.map && state_.predicted < static_cast<int>(state_.map->holes.size());
    changed_ = true;
  }
  woken_.notify_all();
}

void MapMaker::give_up() {
  {
    const std::scoped_lock lock(mutex_);
    given_up_ = true;
  }
  woken_.notify_all();
}

std::optional<LiveMap> MapMaker::news() {
  const std::scoped_lock lock(mutex_);
  if (!std::exchange(changed_, false)) return std::nullopt;
  return state_;
}

void MapMaker::make(const std::shared_ptr<const Model>& model) {
  auto ways = map_ways(*model, plan_of_, "the template");
  const std::scoped_lock lock(mutex_);
  if (ways) {
    state_.map = std::move(*ways);
    for (const HoleRow& row : state_.map->holes) state_.predicted += row.failed.empty() ? 0 : 1;
    state_.predicting = wanted_;
  } else {
    state_.why_not = ways.error().what;
  }
  changed_ = true;
}

/// Waits until a hole is to be simulated and returns its index. Empty: the thread should end.
std::optional<std::size_t> MapMaker::next_hole() {
  std::unique_lock lock(mutex_);
  woken_.wait(lock, [this] { return given_up_ || wanted_; });
  if (given_up_ || !state_.map) return std::nullopt;
  const auto& holes = state_.map->holes;
  // The planned hole comes first, because users look at it first.
  std::optional<std::size_t> next;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (holes[i].prediction || !holes[i].failed.empty()) continue;
    if (holes[i].hole == state_.map->planned) return i;
    if (!next) next = i;
  }
  return next;
}

void MapMaker::predict(std::size_t hole) {
  const Progress progress = [this](std::string_view /*stage*/, double /*fraction*/) {
    if (given_up_ || !wanted_) throw Unwanted();
  };
  std::optional<Result<Prediction>> predicted;
  survive(
      "the insertion through a hole",
      [&] {
        const std::string name = [this, hole] {
          const std::scoped_lock lock(mutex_);
          return state_.map->holes[hole].hole;
        }();
        try {
          predicted = predict_hole(needles_.scenario, needles_.mesh, plan_of_(name), targets_, progress, needles_.own);
        } catch (const Unwanted&) {  // it will be simulated from its start next time
        }
      },
      [&](const Error& why) { predicted = why; });
  if (!predicted) return;
  const std::scoped_lock lock(mutex_);
  HoleRow& row = state_.map->holes[hole];
  if (*predicted) {
    row.prediction = std::move(**predicted);
  } else {
    row.failed = predicted->error().what;
  }
  ++state_.predicted;
  state_.predicting = wanted_ && state_.predicted < static_cast<int>(state_.map->holes.size());
  changed_ = true;
}

}  // namespace stylet::serve
