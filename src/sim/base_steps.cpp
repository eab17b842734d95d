// SPDX-License-Identifier: GPL-3.0-or-later
#include "base_steps.hpp"

#include "stylet/sim/harms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

Vec3 rigid_tip(const Pose& base, double length_mm) { return base.origin + length_mm * (base.rotation * Vec3::UnitZ()); }

BaseSteps planned_steps(const Model& model, const PlannedInsertion& insertion) {
  const long step_ns = std::max(1L, std::lround(model.scenario().run.dt_ms * 1e6));
  const auto seconds = [step_ns](long k) { return static_cast<double>(k * step_ns) / 1e9; };
  BaseSteps motion;
  motion.count = static_cast<long>(std::ceil(insertion.motion.duration_s() / seconds(1) - 1e-9));
  motion.duration_s = insertion.motion.duration_s();
  motion.base = [seconds, &insertion](long k) { return insertion.motion.at(seconds(k)); };
  motion.dt_s = [seconds](long /*k*/) { return seconds(1); };
  return motion;
}

long deepest_step(const Model& model, const PlannedInsertion& insertion, const BaseSteps& motion) {
  long deepest = motion.count;
  double most = -std::numeric_limits<double>::infinity();
  for (long k = 1; k <= motion.count; ++k) {
    const Vec3 tip = rigid_tip(motion.base(k), model.scenario().needle.length_mm);
    const double depth = (tip - insertion.entry).dot(insertion.direction);
    if (depth < most - 1e-9) continue;
    most = std::max(most, depth);
    deepest = k;
  }
  return deepest;
}

void StepRemarks::add(const Simulation& simulation) {
  ++steps_;
  if ((simulation.last_step().flags & Step::kDistrusted) != 0) ++without_balance_;
  unbroken_.add(simulation);
  for (const Event& event : simulation.new_events()) {
    const auto same = [&](const Event& before) { return before.region == event.region; };
    if (event.kind == EventKind::region_entered && std::none_of(entered_.begin(), entered_.end(), same))
      entered_.push_back(event);
  }
}

std::vector<std::string> StepRemarks::sentences() const {
  std::vector<std::string> remarks = harms(entered_);
  for (std::string& warning : unbroken_.warnings()) remarks.push_back(std::move(warning));
  if (without_balance_ > 0) {
    remarks.push_back(
        fmt::format("In {} of {} steps no balance of needle and tissue was found; a smaller run.dt_ms helps.",
                    without_balance_, steps_));
  }
  return remarks;
}

std::optional<Vec3> tip_error_mm(const Insertion& insertion, const Step& step) {
  if (step.tip_state == TipState::air || step.tip_state == TipState::exited) return std::nullopt;
  return insertion.track().end - rigid_tip(step.base, insertion.needle().length());
}

}  // namespace stylet
