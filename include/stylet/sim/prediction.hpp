// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// What a needle will do on its way in: the same numbers as those of a Summary.
struct Prediction {
  std::optional<Vec3> shift_at_break_mm;  ///< GlandMotion::shift_at_break_mm; empty without a target, too
  std::optional<Vec3> shift_max_mm;       ///< GlandMotion::shift_max_mm; empty without a target
  std::optional<Vec3> tip_error_mm;       ///< Summary::tip_error_mm
  std::vector<std::string> remarks;       ///< one sentence each: what was harmed, what did not break, what to distrust
};

/// Inserts the needle of a model's first insertion up to its deepest point, the dwell included, exactly as run() does,
/// and no further: neither pictures nor the way out are computed.
/// @param progress of the insertion; may throw, to give up
Result<Prediction> predict(const std::shared_ptr<const Model>& model, const Progress& progress = {});

}  // namespace stylet
