// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace stylet {

/// When a periodic loop is due, and how much time each turn stands for. Deadlines lie on the grid origin + k T and stay
/// there: a late turn is not made up for by a quicker one, the points of the grid it passed over are skipped and the
/// next turn waits for the next point ahead. The next turn then stands for all time since the last one, so simulated
/// time keeps up with the clock, but for at most `max_periods`: what a long stall takes beyond that is lost to
/// simulated time, for a needle must not leap. No clock inside: times are arguments.
class PeriodGrid {
 public:
  /// @param origin_ns first turn @param period_ns T > 0 @param max_periods ≥ 1
  PeriodGrid(std::int64_t origin_ns, std::int64_t period_ns, int max_periods)
      : origin_(origin_ns), period_(period_ns), most_(max_periods) {}

  /// When the next turn is due.
  [[nodiscard]] std::int64_t due_ns() const { return origin_ + tick_ * period_; }
  /// Point of the grid of the next turn.
  [[nodiscard]] std::int64_t tick() const { return tick_; }

  /// The loop is awake. Points that passed meanwhile are skipped: the turn belongs to the last one not after now.
  void wake(std::int64_t now_ns);

  /// Time since the last turn that was taken, or the start [ns]: a whole number of periods, 1…max_periods.
  std::int64_t take();
  /// This turn is not taken (paused): its time does not count.
  void pass() { taken_ = tick_; }

  /// The turn is over. @return true when it missed its deadline: the point of the grid after the one it was due at,
  /// whether it was woken too late or took too long
  bool finish(std::int64_t now_ns);

  [[nodiscard]] std::int64_t skipped() const { return skipped_; }         ///< points without a turn
  [[nodiscard]] std::int64_t lost_ns() const { return lost_ * period_; }  ///< time that take() has left out

 private:
  [[nodiscard]] std::int64_t last_before(std::int64_t now_ns) const;

  std::int64_t origin_;
  std::int64_t period_;
  int most_;
  std::int64_t tick_ = 0;
  std::int64_t due_ = 0;  ///< point at which the present turn was due
  std::int64_t taken_ = -1;
  std::int64_t skipped_ = 0;
  std::int64_t lost_ = 0;
};

}  // namespace stylet
