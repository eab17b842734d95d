// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exchange.hpp"
#include "stylet/realtime/period_grid.hpp"
#include "stylet/realtime/runner.hpp"

namespace stylet {

/// The step's thread. In each turn it reads the handle's pose, moves the base, takes a step, and publishes the result.
/// Nothing in run() allocates, locks, throws or logs.
class StepLoop {
 public:
  StepLoop(Steppable& body, const BaseFollower& follower, const RunnerSettings& settings, Exchange& exchange,
           LoopTimes& times);

  /// Runs until Exchange::stop is set.
  /// @param clock_zero_ns start of the runner's clock, on CLOCK_MONOTONIC @param origin_ns time of the first turn
  void run(std::int64_t clock_zero_ns, std::int64_t origin_ns) noexcept;

 private:
  [[nodiscard]] bool wants_step(bool& single);
  void step(double dt, double now_s);
  void publish(bool paused);
  [[nodiscard]] double clock_s() const;

  Steppable& body_;
  BaseFollower follower_;
  const RunnerSettings& settings_;
  Exchange& exchange_;
  LoopTimes& times_;
  std::int64_t period_ns_;
  std::int64_t zero_ns_ = 0;
  std::int64_t simulated_ns_ = 0;
  std::int64_t single_done_ = 0;
  bool said_paused_ = false;
  StepOutcome outcome_;
  LoopCounters counters_;
  LoopCounters before_;  ///< counters of earlier runs, to which those of the present PeriodGrid are added
};

}  // namespace stylet
