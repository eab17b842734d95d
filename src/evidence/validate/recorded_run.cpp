// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/recorded_run.hpp"

namespace stylet::validate {

namespace {

/// Stores every step and the labelled frames of a run.
class Keeper final : public RunObserver {
 public:
  explicit Keeper(RecordedRun& run) : run_(run) {}
  Result<> on_step(const Step& step) override {
    run_.steps.push_back(step);
    return Ok{};
  }
  Result<> on_frame(const Frame& frame) override {
    if (!frame.label.empty()) run_.events.push_back(frame);
    return Ok{};
  }

 private:
  RecordedRun& run_;
};

}  // namespace

const Event* RecordedRun::event(EventKind kind, const std::string& region) const {
  for (const Event& event : summary.events) {
    if (event.kind == kind && (region.empty() || event.region == region)) return &event;
  }
  return nullptr;
}

Result<RecordedRun> record_run(const std::shared_ptr<const Model>& model, const Progress& progress) {
  KnownTargets none;
  return record_run(model, none, progress);
}

Result<RecordedRun> record_run(const std::shared_ptr<const Model>& model, KnownTargets& targets,
                               const Progress& progress) {
  RecordedRun recorded;
  recorded.model = model;
  Keeper keeper(recorded);
  auto summary = run(model, keeper, targets, progress);
  if (!summary) return summary.error();
  recorded.summary = std::move(*summary);
  return recorded;
}

}  // namespace stylet::validate
