// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/sim/model.hpp"
#include "stylet/sim/run.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet::measure {

/// An insertion that has been carried out, with every step.
struct RecordedRun {
  std::shared_ptr<const Model> model;
  std::vector<Step> steps;
  std::vector<Frame> events;  ///< frames taken at events and at the deepest point, labelled
  Summary summary;

  /// The first event of a kind, in a region where one is named; null where there is none.
  [[nodiscard]] const Event* event(EventKind kind, const std::string& region = {}) const;
};

/// Carries out all insertions of a model.
Result<RecordedRun> record_run(const std::shared_ptr<const Model>& model, const Progress& progress = {});

}  // namespace stylet::measure
