// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

#include <span>

namespace stylet {

class KnownTargets;

/// Receives the steps and frames of a run. A call may return an Error to stop the run.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual Result<> on_step(const Step& step) = 0;
  virtual Result<> on_frame(const Frame& frame) = 0;
};

/// Simulates all insertions of a model, one after the other. Needles that stay (Model::staying()) go in first; their
/// steps are not recorded, and time counts from the moment when they are in place. Frames of each insertion: "before";
/// one per event, labelled with the event's name, except for region_entered, retraction_start and withdrawn; "deepest";
/// "after"; and unlabelled ones at scenario.output.frames_per_s, at most output.max_frames.
/// @return the results; apart from the step times, two runs give the same numbers
Result<Summary> run(const std::shared_ptr<const Model>& model, RunObserver& observer, const Progress& progress = {});

/// The same for one of several runs of one patient. Solving for the motion of the target is a large part of a short
/// run.
/// @param targets cache, from which the next run takes that motion where its tissue is the same
Result<Summary> run(const std::shared_ptr<const Model>& model, RunObserver& observer, KnownTargets& targets,
                    const Progress& progress = {});

/// Simulates the model's only insertion with the base motion of a recording, step by step. With the model that the
/// recording was made with, all numbers are the same to the last bit, except where the needle had outrun its compliance
/// (Step::compliance_missing), since the progress of the thread that computed compliance is not recorded.
/// @param steps of the recording; their base, dt_s and rest_steps are used
/// Errors: no steps, steps without base (files of the first version), a model with several insertions
Result<Summary> run_recorded(const std::shared_ptr<const Model>& model, std::span<const Step> steps,
                             RunObserver& observer, const Progress& progress = {});

}  // namespace stylet
