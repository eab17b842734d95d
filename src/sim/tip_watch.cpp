// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/tip_watch.hpp"

#include "base_steps.hpp"

namespace stylet {

void TipWatch::follow(const Insertion& insertion, const Step& step) {
  if ((step.flags & Step::invalid_input) != 0) return;
  const auto now = tip_error_mm(insertion, step);
  if (!now) {
    deepest_.reset();
    return;
  }
  if (step.tip_state == TipState::in_track) return;  // the tip is behind the end of the track
  if (deepest_ && step.base_depth_mm < deepest_->base_depth_mm - 1e-9) return;
  deepest_ = TipError{*now, step.base_depth_mm};
}

}  // namespace stylet
