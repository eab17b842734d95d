// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/run_recorder.hpp"

#include "record/csv.hpp"
#include "record/run_columns.hpp"
#include "recorder.hpp"

namespace stylet {

struct RunRecorder::Parts {
  explicit Parts(results::RunFileWriter writer) : recorder(std::move(writer)) {}
  results::Recorder recorder;
};

Result<std::unique_ptr<RunRecorder>> RunRecorder::open(const std::filesystem::path& file, const RunInfo& info,
                                                       const TetMesh& mesh, const RecordedPlan* plan) {
  auto writer = results::RunFileWriter::create(file, info, mesh, {}, plan);
  if (!writer) return writer.error();
  return std::unique_ptr<RunRecorder>(new RunRecorder(std::make_unique<Parts>(std::move(*writer))));
}

RunRecorder::RunRecorder(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
RunRecorder::~RunRecorder() = default;

void RunRecorder::write_now(std::chrono::milliseconds most) { parts_->recorder.write_now(most); }
Result<> RunRecorder::add_step(const Step& step) { return parts_->recorder.add(step); }
Result<> RunRecorder::add_event(const Event& event) { return parts_->recorder.add(event); }
Result<> RunRecorder::add_probe_move(const ProbeMove& move) { return parts_->recorder.add(move); }
Result<> RunRecorder::add_act(const SeedAct& act) { return parts_->recorder.add(act); }
Result<> RunRecorder::add_dose(const RecordedScore& dose) { return parts_->recorder.add(dose); }
Result<> RunRecorder::add_frame(const Frame& frame) {
  results::StoredFrame stored;
  stored.displacement.reserve(static_cast<std::size_t>(frame.displacement.size()));
  for (const double value : frame.displacement) stored.displacement.push_back(static_cast<float>(value));
  stored.frame = frame;
  stored.frame.displacement.resize(0);
  return parts_->recorder.add(std::move(stored));
}

std::string forces_csv_text(std::span<const Step> steps) { return record::csv_of(steps); }

}  // namespace stylet
