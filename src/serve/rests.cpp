// SPDX-License-Identifier: GPL-3.0-or-later
#include "rests.hpp"

#include "stylet/sim/recorded_steps.hpp"

#include <cmath>
#include <utility>

namespace stylet::serve {

bool Rests::follows(const Step& step) const {
  return !record_ || std::abs(step.time_s - last_.time_s - step.dt_s) < 0.5 * step.dt_s;
}

std::optional<Step> Rests::add(const Step& step) {
  last_ = step;
  // Compared with the recorded step, not with the previous step, so that small changes cannot add up to a drift.
  if (record_ && is_at_rest(*record_, step)) {
    ++resting_;
    return std::nullopt;
  }
  record_ = step;
  record_->rest_steps = std::exchange(resting_, 0);
  return record_;
}

std::optional<Step> Rests::end() {
  if (resting_ == 0) return std::nullopt;
  last_.rest_steps = std::exchange(resting_, 0) - 1;
  return last_;
}

}  // namespace stylet::serve
