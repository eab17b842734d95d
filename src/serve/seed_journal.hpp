// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/recorded_implant.hpp"
#include "stylet/serve/implant_picture.hpp"

#include <vector>

namespace stylet::serve {

/// Turns what has been carried out of a plan into rows of a recording: the seeds that were there when it began, then
/// each drop, each seed that was taken back or that a strand has moved, and the dose after them.
class SeedJournal {
 public:
  struct News {
    std::vector<SeedAct> acts;
    std::vector<RecordedScore> doses;
  };
  /// The changes since the last call. The first call gives the seeds of earlier needles.
  /// @param time_s [s] simulated time of the recording @param score_is_current LiveImplant::now is of all its seeds
  [[nodiscard]] News news(const LiveImplant& implant, bool score_is_current, double time_s);

 private:
  std::vector<SeedHistory> seeds_;  ///< as recorded
  bool has_begun_ = false;
  bool has_plan_dose_ = false;
  double last_s_ = 0.0;  ///< time of the last act
  std::int64_t acts_ = 0;
  std::int64_t dose_after_ = -1;  ///< number of acts before the last dose
};

}  // namespace stylet::serve
