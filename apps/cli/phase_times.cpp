// SPDX-License-Identifier: GPL-3.0-or-later
#include "phase_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

namespace stylet::cli {

/// Adds the time since the present phase began. The mutex is locked.
void PhaseTimes::end_present() {
  const double now_s = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  phases_[present_].seconds += now_s - since_s_;
  since_s_ = now_s;
}

void PhaseTimes::enter(std::string_view phase) {
  const std::scoped_lock lock(mutex_);
  if (phases_[present_].name == phase) return;
  end_present();
  const auto known = std::ranges::find(phases_, phase, &Phase::name);
  present_ = static_cast<std::size_t>(known - phases_.begin());
  if (known == phases_.end()) phases_.push_back({std::string(phase)});
}

std::string PhaseTimes::table() {
  const std::scoped_lock lock(mutex_);
  end_present();
  std::string text = "Processor time by phase:";
  double all = 0.0;
  for (const Phase& phase : phases_) {
    text += fmt::format("\n{:9.2f} s  {}", phase.seconds, phase.name);
    all += phase.seconds;
  }
  return text + fmt::format("\n{:9.2f} s  in all", all);
}

}  // namespace stylet::cli
