// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/mean_displacement.hpp"
#include "stylet/sim/model.hpp"

namespace stylet {

/// How far a needle has moved the target of a model. Not for the loop: it solves for whole displacements.
class TargetMotion {
 public:
  /// The target's mean displacement is solved for once, on coarse meshes with finer elements than those of the step.
  /// @param model outlives this
  static Result<TargetMotion> of(const Model& model, const Progress& progress = {});

  [[nodiscard]] TargetShift shift(const Insertion& insertion) const;

 private:
  TargetMotion(const Model& model, MeanDisplacement mean) : model_(&model), mean_(std::move(mean)) {}

  const Model* model_;
  MeanDisplacement mean_;
};

}  // namespace stylet
