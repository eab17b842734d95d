// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace stylet {

/// Schedule of a periodic loop: when each turn (one pass of the loop) is due, and how much simulated time it stands
/// for. Deadlines are the points origin + k T of a fixed grid. A late turn is not compensated by shorter ones: the
/// points that it passed are skipped, and the next turn waits for the next point ahead. That turn stands for the whole
/// time since the last one, so simulated time keeps up with the clock, but for at most `max_periods`; the time of a
/// longer stall is lost for the simulation, because the needle must not jump. No clock is used; times are arguments.
class PeriodGrid {
 public:
  /// @param origin_ns [ns] time of the first turn @param period_ns [ns] T > 0 @param max_periods ≥ 1
  PeriodGrid(std::int64_t origin_ns, std::int64_t period_ns, int max_periods)
      : origin_(origin_ns), period_(period_ns), most_(max_periods) {}

  /// Time at which the next turn is due [ns].
  [[nodiscard]] std::int64_t due_ns() const { return origin_ + tick_ * period_; }
  /// Index k of the next turn's point of the grid.
  [[nodiscard]] std::int64_t tick() const { return tick_; }

  /// Call when the loop has woken up. Points that have passed are skipped: the turn belongs to the last point not after
  /// `now_ns`.
  void wake(std::int64_t now_ns);

  /// Takes this turn. @return simulated time [ns] since the last turn taken, or since the start: 1…max_periods periods
  std::int64_t take();
  /// Skips this turn because of a pause; its time does not count.
  void pass() { taken_ = tick_; }

  /// Call when the turn is over. @return whether the turn missed its deadline, which is the point of the grid after the
  /// one at which it was due; it may have been woken too late or taken too long
  bool finish(std::int64_t now_ns);

  [[nodiscard]] std::int64_t skipped() const { return skipped_; }         ///< number of points without a turn
  [[nodiscard]] std::int64_t lost_ns() const { return lost_ * period_; }  ///< time lost beyond max_periods

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
