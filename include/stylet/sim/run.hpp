// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

namespace stylet {

/// Who watches a run. Calls may return an Error to stop it.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual Result<> on_step(const StepRecord& step) = 0;
  virtual Result<> on_frame(const Frame& frame) = 0;
};

/// Carries out all insertions of a model, one after the other, and sums up.
/// Frames: one before, one per event worth a picture (labelled with the event's name), one at the deepest point
/// ("deepest"), one after, and a regular series at scenario.output.frames_per_s, at most max_frames.
/// @return what the run came to, without the step times' effect on anything else
Result<Summary> run(const std::shared_ptr<const Model>& model, RunObserver& observer, const Progress& progress = {});

}  // namespace stylet
