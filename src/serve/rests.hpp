// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <optional>

namespace stylet::serve {

/// Leaves out of a recording what a needle at rest repeats: steps that were given what the last record was given, bit
/// for bit, and came to the same (is_at_rest). They are only counted (Step::rest_steps), so whoever repeats a
/// recording still takes every step that there was.
class Rests {
 public:
  /// Whether a step is the one after the last that was added, with none missing in between.
  [[nodiscard]] bool follows(const Step& step) const;
  /// @return the record to write, with the steps at rest before it; nothing: the step is one of those
  std::optional<Step> add(const Step& step);
  /// Nothing comes any more. @return the last step, if it is at rest
  std::optional<Step> end();

 private:
  std::optional<Step> record_;  ///< the last one
  Step last_;                   ///< step
  std::int64_t resting_ = 0;    ///< steps since the last record
};

}  // namespace stylet::serve
