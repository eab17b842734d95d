// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/volume_motion.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <optional>

namespace stylet {

/// Computes how far a needle has moved the target of a model.
class TargetMotion {
 public:
  /// Solves once for the target's motion per force. On coarse meshes this uses finer elements than the steps do.
  /// @param model must outlive the result
  static Result<TargetMotion> of(const Model& model, const Progress& progress = {});

  /// The target motion of another model, sharing this solution if it is the same to the last bit: mesh, materials,
  /// target and held nodes must be the same, and the mesh must be small enough that the solution does not depend on the
  /// needle's way. Otherwise empty.
  /// @param other must outlive the result
  [[nodiscard]] std::optional<TargetMotion> shared_with(const Model& other) const;

  /// The motion of the target at one moment.
  struct Moment {
    VolumeMotion motion;  ///< the shift of a third without tissue is NaN
    bool at_rest = true;  ///< no force acts on the tissue
  };
  /// The target's motion after the last step. Takes microseconds; allocates only when there are more forces than in any
  /// earlier call.
  Moment now(const Insertion& insertion);

  /// The target's shift after the last step. Solves for the displacement of all nodes, so it is too slow for every
  /// step.
  [[nodiscard]] TargetShift shift(const Insertion& insertion);

 private:
  TargetMotion(const Model& model, std::shared_ptr<const VolumeResponse> response)
      : model_(&model), response_(std::move(response)) {}

  const Model* model_;
  std::shared_ptr<const VolumeResponse> response_;
  std::vector<TissueForce> forces_;  ///< scratch
};

}  // namespace stylet
