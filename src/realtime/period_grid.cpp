// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/period_grid.hpp"

#include <algorithm>

namespace stylet {

std::int64_t PeriodGrid::last_before(std::int64_t now_ns) const {
  return now_ns < origin_ ? -1 : (now_ns - origin_) / period_;
}

void PeriodGrid::wake(std::int64_t now_ns) {
  const std::int64_t now = std::max(last_before(now_ns), tick_);
  skipped_ += now - tick_;
  due_ = tick_;
  tick_ = now;
}

std::int64_t PeriodGrid::take() {
  const std::int64_t passed = tick_ - taken_;
  const std::int64_t counted = std::min<std::int64_t>(passed, most_);
  lost_ += passed - counted;
  taken_ = tick_;
  return counted * period_;
}

bool PeriodGrid::finish(std::int64_t now_ns) {
  const std::int64_t passed = last_before(now_ns);
  const bool missed = now_ns > origin_ + (due_ + 1) * period_;
  // The next turn is at the next point ahead; a point that is reached exactly now is taken at once.
  std::int64_t next = std::max(passed, tick_) + 1;
  if (passed > tick_ && origin_ + passed * period_ == now_ns) next = passed;
  skipped_ += next - tick_ - 1;
  tick_ = next;
  return missed;
}

}  // namespace stylet
