// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exchange.hpp"
#include "stylet/realtime/period_grid.hpp"
#include "stylet/realtime/runner.hpp"

namespace stylet {

/// The step's thread: where the handle is → where the base goes → a step → who wants to know. Nothing in run()
/// allocates, locks, throws or logs.
class StepLoop {
 public:
  StepLoop(Steppable& body, const BaseFollower& follower, const RunnerSettings& settings, Exchange& exchange,
           LoopTimes& times);

  /// @param clock_zero_ns of the runner's clock, on CLOCK_MONOTONIC @param origin_ns first turn
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
  LoopCounters before_;  ///< of earlier runs, for what PeriodGrid counts
};

}  // namespace stylet
