// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"

#include <functional>
#include <optional>

namespace stylet {

/// What the base does in an insertion, step by step from 1 on.
struct BaseSteps {
  long count = 0;
  double duration_s = 0.0;
  std::function<Pose(long k)> base;
  std::function<double(long k)> dt_s;
};

/// The steps of a planned insertion with the time step of the model's scenario.
/// @param insertion outlives what is returned
BaseSteps planned_steps(const Model& model, const PlannedInsertion& insertion);

/// The step after which the base is furthest in; of several the last, just before it goes out.
long deepest_step(const Model& model, const PlannedInsertion& insertion, const BaseSteps& motion);

/// How far the needle's tip is, in the material, from where it was to be: the deepest point of its track less the point
/// that the tip of a rigid straight needle on the same base would reach in a patient that nothing has moved.
/// @param step that has just been taken, with which the needle is deepest
/// @return [mm] LPS; empty where the tip is not in the tissue
std::optional<Vec3> tip_error_mm(const Insertion& insertion, const Step& step);

}  // namespace stylet
