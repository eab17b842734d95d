// SPDX-License-Identifier: GPL-3.0-or-later
#include "live_recording.hpp"

#include "scene_points.hpp"
#include "wall_clock.hpp"

#include "io/detail/private_files.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace stylet::serve {

namespace {

constexpr double kStill_N = 1e-4;                        ///< a smaller change of the axial force counts as none
constexpr std::chrono::milliseconds kLongestWrite{200};  ///< a disk that hangs does not stop the session
constexpr double kShareForFrames = 0.05;                 ///< share of this thread's time for frames of the recording

}  // namespace

void LiveRecording::begin(const std::filesystem::path& folder, const RunInfo& info, const TetMesh& mesh,
                          const RecordedPlan* plan) {
  detail::make_private_folder(folder.parent_path());
  detail::make_private_folder(folder);
  in_use_ = FolderLock(folder, FolderLock::Kind::shared);  // first, so that nobody removes the new recording
  auto recorder = RunRecorder::open(folder / "run.h5", info, mesh, plan);
  if (!recorder) {
    problem_ = recorder.error().message();
    std::error_code ignored;
    std::filesystem::remove(folder, ignored);  // nothing is in it
    return;
  }
  detail::make_private(folder / "run.h5");
  recorder_ = std::move(*recorder);
}

void LiveRecording::note(const Result<>& done) {
  if (done.ok()) return;
  problem_ = done.error().message();
  recorder_.reset();
}

void LiveRecording::lacks(const std::string& what) {
  if (problem_.empty()) problem_ = what;
}

void LiveRecording::stop(const std::string& why) {
  if (!recorder_) return;
  end_rest();
  recorder_.reset();
  problem_ = why;
}

void LiveRecording::end_rest() {
  if (const auto step = rests_.end(); step && recorder_) note(recorder_->add_step(*step));
}

void LiveRecording::add(const Step& step) {
  if (!rests_.follows(step)) {  // steps are missing: end the rest before the gap
    end_rest();
    rests_ = {};
  }
  if (const auto kept = rests_.add(step); kept && recorder_) note(recorder_->add_step(*kept));
}

void LiveRecording::add(const Event& event) {
  if (recorder_) note(recorder_->add_event(event));
}

void LiveRecording::add(const Frame& frame) {
  if (recorder_) note(recorder_->add_frame(frame));
}

bool LiveRecording::add(const LiveImplant& implant, bool score_is_current, double time_s) {
  const SeedJournal::News news = journal_.news(implant, score_is_current, time_s);
  for (const SeedAct& act : news.acts) {
    if (recorder_) note(recorder_->add_act(act));
  }
  for (const RecordedScore& dose : news.doses) {
    if (recorder_) note(recorder_->add_dose(dose));
  }
  if (recorder_ && !news.acts.empty()) recorder_->write_now(kLongestWrite);
  return !news.acts.empty();
}

void LiveRecording::add(const ProbeSettings& probe, double time_s) {
  if (!recorder_ || probe.kind == ProbeKind::none || probe == last_probe_) return;
  note(recorder_->add_probe_move({time_s, probe}));
  last_probe_ = probe;
}

RecordedFrames::RecordedFrames(const std::shared_ptr<const Model>& model, double frames_per_s)
    : near_(model, nodes_as_points(model->mesh())),
      nodes_(static_cast<std::size_t>(model->mesh().node_count())),
      every_s_(1.0 / frames_per_s) {
  std::iota(nodes_.begin(), nodes_.end(), Index{0});
}

/// When a needle moves again after a rest, its last frame is recorded once more with the time at which the rest ended,
/// so that interpolation between frames shows the rest.
void RecordedFrames::record(const Snapshot& snapshot, std::span<const TissueForce> forces, const DisplayField& field,
                            DisplayField::Load& load, LiveRecording& recording) {
  const Step& step = snapshot.step;
  if (last_ && step.base.origin == last_base_.origin && step.base.rotation.coeffs() == last_base_.rotation.coeffs() &&
      std::abs(step.force_axial_N - last_force_N_) < kStill_N) {
    resting_until_s_ = step.time_s;
    return;
  }
  if (last_ && resting_until_s_ > last_->time_s) {
    last_->time_s = resting_until_s_;
    recording.add(*last_);
    if (!recording.is_on()) return;
  }
  const double before = wall_clock_s();
  Frame frame;
  frame.time_s = step.time_s;
  frame.base_depth_mm = step.base_depth_mm;
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(nodes_.size()));
  field.displacement(nodes_, load, u);
  near_.set(forces);
  near_.add(u);
  frame.displacement = u.reshaped().cast<double>();
  for (const Triple& point : snapshot.centreline) frame.needle.push_back(vec3(point));
  for (const ContactSnapshot& c : std::span(snapshot.contacts).first(static_cast<std::size_t>(snapshot.contact_count)))
    frame.contacts.push_back({vec3(c.position), vec3(c.force), c.s, c.sticking, c.tip});
  recording.add(frame);
  last_ = std::move(frame);
  last_base_ = step.base;
  last_force_N_ = step.force_axial_N;
  next_s_ = step.time_s + std::max(every_s_, (wall_clock_s() - before) / kShareForFrames);
}

}  // namespace stylet::serve
