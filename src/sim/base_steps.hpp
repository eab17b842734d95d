// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/clock.hpp"
#include "stylet/sim/simulation.hpp"
#include "stylet/sim/unbroken_surface.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// The base motion of an insertion as steps k = 1 … count: the pose after each step and its duration.
struct BaseSteps {
  long count = 0;
  double duration_s = 0.0;
  std::function<Pose(long k)> base;
  std::function<double(long k)> dt_s;
};

/// Tip [mm] LPS of a rigid straight needle on this base.
Vec3 rigid_tip(const Pose& base, double length_mm);

/// The steps of a planned insertion with the time step of the model's scenario.
/// @param insertion must outlive the result
BaseSteps planned_steps(const Model& model, const PlannedInsertion& insertion);

/// The step after which the base is deepest; of several equally deep steps the last, just before the base goes out.
long deepest_step(const Model& model, const PlannedInsertion& insertion, const BaseSteps& motion);

/// Takes steps 1 … last of a motion, each with its compliance prepared. After step k calls `watch(k, step, cpu_us)`,
/// with the processor time of the step alone [µs]; an error of it ends the motion.
template <class Watch>
Result<> drive(Simulation& simulation, const BaseSteps& motion, long last, Watch&& watch) {
  for (long k = 1; k <= last; ++k) {
    const Pose base = motion.base(k);
    const double dt = motion.dt_s(k);
    simulation.prepare();
    const std::int64_t before = thread_cpu_ns();
    const Step& step = simulation.step(base, dt);
    if (Result<> seen = watch(k, step, 1e-3 * static_cast<double>(thread_cpu_ns() - before)); !seen) return seen;
  }
  return Ok{};
}

/// Collects remarks about the steps of an insertion: organs harmed, surfaces unbroken, steps without a balance.
class StepRemarks {
 public:
  /// Call after each step. Allocates.
  void add(const Simulation& simulation);
  [[nodiscard]] std::vector<std::string> sentences() const;

 private:
  std::vector<Event> entered_;  ///< each region once
  UnbrokenSurface unbroken_;
  long steps_ = 0;
  long without_balance_ = 0;
};

/// Tip error: the deepest material point of the needle's track minus the point that the tip of a rigid straight needle
/// on the same base would reach in a patient that nothing has moved.
/// @param step the last step, with the needle at its deepest
/// @return [mm] LPS; empty if the tip is not in the tissue
std::optional<Vec3> tip_error_mm(const Insertion& insertion, const Step& step);

}  // namespace stylet
