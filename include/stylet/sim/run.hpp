// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

#include <span>

namespace stylet {

/// Who watches a run. Calls may return an Error to stop it.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual Result<> on_step(const Step& step) = 0;
  virtual Result<> on_frame(const Frame& frame) = 0;
};

/// Carries out all insertions of a model, one after the other, and sums up.
/// Frames: one before, one per event worth a picture (labelled with the event's name), one at the deepest point
/// ("deepest"), one after, and a regular series at scenario.output.frames_per_s, at most max_frames.
/// @return what the run came to, without the step times' effect on anything else
Result<Summary> run(const std::shared_ptr<const Model>& model, RunObserver& observer, const Progress& progress = {});

/// Carries out the model's only insertion with the base led as it was in a recording, step by step. With the model that
/// the recording was made with every number is the same to the last bit, but where the needle had outrun its compliance
/// (Step::compliance_missing): how far a worker had come then is not recorded.
/// @param steps their base and dt_s are used
/// Errors: no steps, steps without base (files of the first version), a model of several insertions
Result<Summary> run_recorded(const std::shared_ptr<const Model>& model, std::span<const Step> steps,
                             RunObserver& observer, const Progress& progress = {});

}  // namespace stylet
