// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"

#include <functional>
#include <optional>

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

/// Tip error: the deepest material point of the needle's track minus the point that the tip of a rigid straight needle
/// on the same base would reach in a patient that nothing has moved.
/// @param step the last step, with the needle at its deepest
/// @return [mm] LPS; empty if the tip is not in the tissue
std::optional<Vec3> tip_error_mm(const Insertion& insertion, const Step& step);

}  // namespace stylet
