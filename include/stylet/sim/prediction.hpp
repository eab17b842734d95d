// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/target_motion.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// Figures of one insertion up to its deepest point; they equal the figures of the same names in a Summary.
struct Prediction {
  std::optional<Vec3> shift_at_break_mm;   ///< GlandMotion::shift_at_break_mm; also empty without a target
  std::optional<Vec3> shift_max_mm;        ///< GlandMotion::shift_max_mm; empty without a target
  std::optional<Vec3> tip_error_mm;        ///< Summary::tip_error_mm
  std::optional<NeedlesInPlace> in_place;  ///< Summary::in_place
  std::vector<std::string> remarks;        ///< sentences: organs harmed, surfaces unbroken, steps without a balance
};

/// Cache of target motions: a further model of the same patient and tissue with another needle reuses a solution if
/// possible. Any number of threads may use it.
class KnownTargets {
 public:
  /// TargetMotion::of(), from the cache (TargetMotion::shared_with()) or solved for.
  Result<TargetMotion> of(const std::shared_ptr<const Model>& model, const Progress& progress);

 private:
  struct Known {
    std::shared_ptr<const Model> model;  ///< keeps the motion's model alive
    TargetMotion motion;
  };
  std::mutex mutex_;
  std::vector<Known> known_;  ///< only a few entries, since each keeps a model in memory
};

/// Simulates the first insertion of a model up to its deepest point, dwell included, with the same results as run().
/// Needles that stay (Model::staying()) go in first.
/// Neither pictures nor the way out are computed.
/// @param targets cache for models of the same patient and tissue
/// @param progress of the insertion; may throw to cancel
Result<Prediction> predict(const std::shared_ptr<const Model>& model, KnownTargets& targets,
                           const Progress& progress = {});

}  // namespace stylet
