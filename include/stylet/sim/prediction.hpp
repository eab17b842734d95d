// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/target_motion.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// The figures of a needle's way in: the same numbers as those of a Summary.
struct Prediction {
  std::optional<Vec3> shift_at_break_mm;  ///< GlandMotion::shift_at_break_mm; empty without a target, too
  std::optional<Vec3> shift_max_mm;       ///< GlandMotion::shift_max_mm; empty without a target
  std::optional<Vec3> tip_error_mm;       ///< Summary::tip_error_mm
  std::vector<std::string> remarks;       ///< one sentence each: what was harmed, what did not break, what to distrust
};

/// The motions of targets that were solved for, for the next model of the same patient and tissue with another needle:
/// what is known already takes no time. Any number of threads may use it.
class KnownTargets {
 public:
  /// TargetMotion::of(), solved for or shared.
  Result<TargetMotion> of(const std::shared_ptr<const Model>& model, const Progress& progress);

 private:
  struct Known {
    std::shared_ptr<const Model> model;  ///< which the motion refers to
    TargetMotion motion;
  };
  std::mutex mutex_;
  std::vector<Known> known_;  ///< few: each keeps a model
};

/// Inserts the needle of a model's first insertion up to its deepest point, the dwell included, exactly as run() does,
/// and no further: neither pictures nor the way out are computed.
/// @param targets of models of the same patient and tissue
/// @param progress of the insertion; may throw, to give up
Result<Prediction> predict(const std::shared_ptr<const Model>& model, KnownTargets& targets,
                           const Progress& progress = {});

}  // namespace stylet
