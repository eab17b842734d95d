// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/volume_motion.hpp"
#include "stylet/sim/model.hpp"

namespace stylet {

/// How far a needle has moved the target of a model.
class TargetMotion {
 public:
  /// The target's motion per force is solved for once, on coarse meshes with finer elements than those of the step.
  /// @param model outlives this
  static Result<TargetMotion> of(const Model& model, const Progress& progress = {});

  /// The target at one moment.
  struct Moment {
    VolumeMotion motion;  ///< thirds are NaN that the target does not have
    bool at_rest = true;  ///< no force acts on the tissue
  };
  /// Microseconds; allocates only where there are more forces than ever before. For each step, between steps.
  Moment now(const Insertion& insertion);

  /// Not for every step: it solves for a whole displacement.
  [[nodiscard]] TargetShift shift(const Insertion& insertion);

 private:
  TargetMotion(const Model& model, VolumeResponse response) : model_(&model), response_(std::move(response)) {}

  const Model* model_;
  VolumeResponse response_;
  std::vector<TissueForce> forces_;  ///< room for those of a moment
};

}  // namespace stylet
