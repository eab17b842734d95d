// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/volume_motion.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <optional>

namespace stylet {

/// How far a needle has moved the target of a model.
class TargetMotion {
 public:
  /// The target's motion per force is solved for once, on coarse meshes with finer elements than those of the step.
  /// @param model outlives this
  static Result<TargetMotion> of(const Model& model, const Progress& progress = {});

  /// The motion of another model's target, where that is the same to the last bit: the same patient and tissue, held at
  /// the same nodes, and a mesh on which the needle's way has no part in it. Nothing is solved then; else it is empty.
  /// @param other outlives what is returned, as does the model of this; of the same mesh, materials and target
  [[nodiscard]] std::optional<TargetMotion> shared_with(const Model& other) const;

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
  TargetMotion(const Model& model, std::shared_ptr<const VolumeResponse> response)
      : model_(&model), response_(std::move(response)) {}

  const Model* model_;
  std::shared_ptr<const VolumeResponse> response_;
  std::vector<TissueForce> forces_;  ///< room for those of a moment
};

}  // namespace stylet
