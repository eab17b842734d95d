// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/sim/model.hpp"
#include "stylet/sim/prediction.hpp"
#include "stylet/sim/run.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet::validate {

/// A simulated insertion with all its steps.
struct RecordedRun {
  std::shared_ptr<const Model> model;
  std::vector<Step> steps;
  std::vector<Frame> events;  ///< labelled frames, taken at events and at the deepest point
  Summary summary;

  /// The first event of a kind, in `region` unless that is empty; null if there is none.
  [[nodiscard]] const Event* event(EventKind kind, const std::string& region = {}) const;
};

/// Simulates all insertions of a model.
Result<RecordedRun> record_run(const std::shared_ptr<const Model>& model, const Progress& progress = {});

/// The same for one of several runs of one patient.
/// @param targets cache of target motions
Result<RecordedRun> record_run(const std::shared_ptr<const Model>& model, KnownTargets& targets,
                               const Progress& progress = {});

}  // namespace stylet::validate
