// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <optional>

namespace stylet::serve {

/// Leaves the repeated steps of a resting needle out of a recording: steps with the same input, bit for bit, and the
/// same result as the last recorded step (is_at_rest). They are counted in Step::rest_steps, so that a recording can
/// still be repeated with every step.
class Rests {
 public:
  /// Whether a step directly follows the last step that was added, with no step missing.
  [[nodiscard]] bool follows(const Step& step) const;
  /// Adds a step. @return the step to record, with the number of steps at rest before it; empty if this step is at rest
  std::optional<Step> add(const Step& step);
  /// Ends the sequence of steps. @return the last step, if it was at rest and has not been recorded
  std::optional<Step> end();

 private:
  std::optional<Step> record_;  ///< the last recorded step
  Step last_;                   ///< the last step
  std::int64_t resting_ = 0;    ///< number of steps since record_
};

}  // namespace stylet::serve
