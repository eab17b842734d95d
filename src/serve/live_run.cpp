// SPDX-License-Identifier: GPL-3.0-or-later
#include "live_run.hpp"

#include "private_files.hpp"
#include "wire.hpp"

#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

namespace stylet::serve {

namespace {

constexpr std::size_t kCurve = 8000;      ///< samples of the curve kept for viewers that connect later
constexpr double kShareOfTime = 0.3;      ///< share of this thread's time for displacements that pages show
constexpr double kStill_N = 1e-4;         ///< a smaller change of the axial force counts as none
constexpr double kShareForFrames = 0.05;  ///< share of this thread's time for frames of the recording

std::vector<SurfacePoint> nodes_as_points(const TetMesh& mesh) {
  std::vector<SurfacePoint> points;
  points.reserve(static_cast<std::size_t>(mesh.node_count()));
  for (Index node = 0; node < mesh.node_count(); ++node) points.push_back({{node, -1, -1}, {1.0, 0.0, 0.0}});
  return points;
}

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

LiveRun::LiveRun(const OpenModel& open, std::size_t insertion, double recorded_frames_per_s)
    : open_(open),
      plan_(open.model->insertions()[insertion]),
      seeds_(open.model),
      near_(open.model, open.points.on_mesh()),
      near_nodes_(open.model, nodes_as_points(open.model->mesh())),
      shown_(Eigen::Matrix3Xf::Zero(3, open.points.count())),
      all_nodes_(static_cast<std::size_t>(open.model->mesh().node_count())),
      room_(Snapshot::kForces),
      step_room_(1024),
      frame_every_s_(1.0 / recorded_frames_per_s) {
  std::iota(all_nodes_.begin(), all_nodes_.end(), Index{0});
  if (open_.field) load_ = open_.field->make_load();
}

LiveRun::~LiveRun() { record_step(rests_.end()); }

void LiveRun::set_field(std::shared_ptr<const DisplayField> field) {
  open_.field = std::move(field);
  load_ = open_.field->make_load();
  owed_ = seen_;
}

Result<std::unique_ptr<LiveRun>> LiveRun::start(const OpenModel& open, std::size_t insertion,
                                                const std::filesystem::path& folder, const RunnerSettings& settings,
                                                double recorded_frames_per_s, std::unique_ptr<Device> other,
                                                const RecordedPlan* plan_of_seeds) {
  std::unique_ptr<LiveRun> run(new LiveRun(open, insertion, recorded_frames_per_s));
  const PlannedInsertion& plan = run->plan_;
  std::shared_ptr<Device> device;
  if (other) {
    device = run->other_ = std::make_shared<PickUp>(std::move(other), plan.motion.at(0.0));
  } else {
    device = run->hand_ = std::make_shared<PageDevice>(plan, open.model->scenario());
  }
  RunnerSettings kept = settings;
  kept.keep_steps = true;
  auto runner =
      RealtimeRunner::create(std::make_unique<SimulationSteppable>(open.model, insertion, run->seeds_.probe()),
                             std::make_unique<SharedDevice>(std::move(device)), kept);
  if (!runner) return runner.error();
  run->runner_ = std::move(*runner);

  RunInfo info = open.model->info(insertion);
  Scenario scenario = open.model->scenario();
  scenario.insertions = {scenario.insertions[insertion]};  // only the insertion that is recorded
  info.scenario_text = to_toml(scenario);
  info.warnings = open.warnings();
  make_private_folder(folder.parent_path());
  make_private_folder(folder);
  run->in_use_ = FolderLock(folder, FolderLock::Kind::shared);  // first, so that nobody removes the new recording
  auto recorder = RunRecorder::open(folder / "run.h5", info, open.model->mesh(), plan_of_seeds);
  if (recorder) {
    make_private(folder / "run.h5");
    run->recorder_ = std::move(*recorder);
  } else {
    run->problem_ = recorder.error().message();
  }
  if (auto started = run->runner_->start(); !started) return started.error();
  return run;
}

void LiveRun::record(const Result<>& done) {
  if (done.ok()) return;
  problem_ = done.error().message();
  recorder_.reset();
}

void LiveRun::stop_recording(const std::string& why) {
  if (!recorder_) return;
  record_step(rests_.end());
  recorder_.reset();
  problem_ = why;
}

void LiveRun::record_step(const std::optional<Step>& step) {
  if (recorder_ && step) record(recorder_->add_step(*step));
}

void LiveRun::record_implant(const LiveImplant& implant, bool score_is_current) {
  const SeedJournal::News news = journal_.news(implant, score_is_current, time_s_);
  if (!news.acts.empty()) record_next_picture();
  for (const SeedAct& act : news.acts) {
    if (recorder_) record(recorder_->add_act(act));
  }
  for (const RecordedScore& dose : news.doses) {
    if (recorder_) record(recorder_->add_dose(dose));
  }
}

void LiveRun::record_probe(const ProbeSettings& probe) {
  if (!recorder_ || probe.kind == ProbeKind::none || probe == last_probe_) return;
  record(recorder_->add_probe_move({time_s_, probe}));
  last_probe_ = probe;
}

void LiveRun::pump(const std::function<void(const LiveEvent&)>& tell) {
  while (const std::size_t count = runner_->take_steps(step_room_)) {
    for (const Step& step : std::span(step_room_).first(count)) {
      if (!rests_.follows(step)) {  // steps are missing: end the rest before the gap
        record_step(rests_.end());
        rests_ = {};
      }
      record_step(rests_.add(step));
      unsent_.push_back(step);
      curve_.push_back(step);
    }
    time_s_ = step_room_[count - 1].time_s;
  }
  if (curve_.size() > 2 * kCurve) wire::thin(curve_, kCurve);
  if (unsent_.size() > 2 * kCurve) wire::thin(unsent_, kCurve);

  const std::vector<std::string>& regions = open_.model->mesh().regions;
  std::array<EventSnapshot, 32> events;
  while (const std::size_t count = runner_->take_events(events)) {
    for (const EventSnapshot& e : std::span(events).first(count)) {
      const std::string region = e.region < 0 ? std::string() : regions[static_cast<std::size_t>(e.region)];
      if (recorder_) record(recorder_->add_event({e.kind, e.time_s, e.depth_mm, e.force_N, region}));
      tell({to_string(e.kind), e.time_s, e.depth_mm, e.force_N, region});
      record_next_picture();
    }
  }
}

/// Whether the newest displacement has not been computed and the share of time for displacements allows it.
bool LiveRun::displacement_is_due() const { return load_ && owed_ && now_s() >= picture_after_s_; }

void LiveRun::compute_displacement() {
  const double before = now_s();
  const ScenePoints& points = open_.points;
  open_.field->displacement(points.nodes, *load_, shown_.leftCols(static_cast<Eigen::Index>(points.nodes.size())));
  points.carry_along(shown_);
  near_.set(tissue_forces(runner_->snapshot(), room_));
  near_.add(shown_);
  seeds_.follow(*open_.field, *load_);
  owed_ = false;
  shown_anew_ = true;
  const double after = now_s();
  picture_after_s_ = after + (after - before) * (1.0 / kShareOfTime - 1.0);
}

/// Records a frame unless the needle rests. When a needle moves again after a rest, its last frame is recorded once
/// more with the time at which the rest ended, so that interpolation between frames shows the rest.
void LiveRun::record_frame(const Snapshot& snapshot) {
  if (last_frame_ && snapshot.step.base.origin == last_base_.origin &&
      snapshot.step.base.rotation.coeffs() == last_base_.rotation.coeffs() &&
      std::abs(snapshot.step.force_axial_N - last_force_N_) < kStill_N) {
    resting_until_s_ = snapshot.step.time_s;
    return;
  }
  if (last_frame_ && resting_until_s_ > last_frame_->time_s) {
    last_frame_->time_s = resting_until_s_;
    record(recorder_->add_frame(*last_frame_));
    if (!recorder_) return;
  }
  const double before = now_s();
  Frame frame;
  frame.time_s = snapshot.step.time_s;
  frame.base_depth_mm = snapshot.step.base_depth_mm;
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(all_nodes_.size()));
  open_.field->displacement(all_nodes_, *load_, u);
  near_nodes_.set(tissue_forces(snapshot, room_));
  near_nodes_.add(u);
  frame.displacement = u.reshaped().cast<double>();
  for (const Triple& point : snapshot.centreline) frame.needle.push_back(vec3(point));
  for (const ContactSnapshot& c : std::span(snapshot.contacts).first(static_cast<std::size_t>(snapshot.contact_count)))
    frame.contacts.push_back({vec3(c.position), vec3(c.force), c.s, c.sticking, c.tip});
  record(recorder_->add_frame(frame));
  last_frame_ = std::move(frame);
  last_base_ = snapshot.step.base;
  last_force_N_ = snapshot.step.force_axial_N;
  next_frame_s_ = snapshot.step.time_s + std::max(frame_every_s_, (now_s() - before) / kShareForFrames);
}

std::shared_ptr<const LiveFrame> LiveRun::picture(bool whole_curve) {
  const bool fresh = runner_->fetch_snapshot();
  seen_ = seen_ || fresh;
  owed_ = owed_ || fresh;
  // While paused there is no fresh snapshot, but its displacement may still be due, and a viewer that has just
  // connected needs the picture again.
  const bool due = displacement_is_due();
  if (!fresh && !whole_curve && !due) return nullptr;
  const Snapshot& s = runner_->snapshot();
  if (load_) {
    open_.field->set(tissue_forces(s, room_), *load_);
    if (recorder_ && fresh && s.step.time_s > 0.0 && s.step.time_s >= next_frame_s_) record_frame(s);
  }

  auto frame = std::make_shared<LiveFrame>();
  frame->time_s = s.step.time_s;
  frame->bits = (s.paused ? LiveFrame::paused : 0U) | (s.trusted ? LiveFrame::trusted : 0U) |
                (whole_curve ? LiveFrame::whole_curve : 0U);
  frame->step = s.step;
  frame->steps = static_cast<std::uint32_t>(s.counters.steps);
  frame->missed = static_cast<std::uint32_t>(s.counters.missed_deadlines);
  const HandTarget hand = hand_ ? hand_->place() : hand_angles(s.step.base, plan_);
  frame->roll_deg = hand.roll_deg;
  frame->tilt_left_deg = hand.tilt_left_deg;
  frame->tilt_anterior_deg = hand.tilt_anterior_deg;
  for (const Triple& point : s.centreline)
    for (const double value : point) frame->centreline.push_back(static_cast<float>(value));
  frame->tip_error = s.tip_error;
  frame->contacts.assign(s.contacts.begin(), s.contacts.begin() + s.contact_count);
  if (due) compute_displacement();
  if (load_) frame->left_out_N = std::max(load_->left_out_N(), near_.left_out_N());  // both of the same forces
  if (due || (load_ && whole_curve)) set_displacement(*frame, shown_);
  if (whole_curve) {
    frame->curve = curve_;
    unsent_.clear();
  } else {
    frame->curve = std::exchange(unsent_, {});
  }
  if (const std::int64_t lost = s.counters.dropped_steps; lost > 0 && problem_.empty())
    problem_ = fmt::format("{} steps were not recorded: the disk or this machine is too slow", lost);
  return frame;
}

void LiveRun::show_to(Companion& companion) {
  runner_->fetch_device();
  if (!seen_) return;
  companion.show(runner_->snapshot(), runner_->device_snapshot());
  if (std::exchange(shown_anew_, false)) companion.show(shown_);
}

std::string LiveRun::device_problem(const Companion& companion) const {
  const DeviceSnapshot& d = runner_->device_snapshot();
  const bool has_pose = d.input.valid && d.clock_s - d.input.time_s <= runner_->settings().late_after_s;
  if (!other_ || has_pose) return {};
  const auto away = other_->away();
  if (!away) return companion.why_no_pose();
  return fmt::format("the handle is {:.0f} mm and {:.0f} degrees away from the needle: move it there", away->mm,
                     away->deg);
}

std::vector<std::string> LiveRun::inside() const {
  const Snapshot& s = runner_->snapshot();
  std::vector<std::string> names;
  for (const std::int16_t region : std::span(s.regions).first(static_cast<std::size_t>(s.region_count)))
    names.push_back(open_.model->mesh().regions[static_cast<std::size_t>(region)]);
  return names;
}

SessionStatus::Loop LiveRun::loop() const {
  const auto times = runner_->times();
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  const Snapshot& s = runner_->snapshot();
  return {.steps = s.counters.steps,
          .missed = s.counters.missed_deadlines,
          .p50_us = us(times->step_cpu.quantile_ns(0.5)),
          .p99_us = us(times->step_cpu.quantile_ns(0.99)),
          .max_us = us(times->step_cpu.largest_ns()),
          .rights = runner_->rights().describe()};
}

}  // namespace stylet::serve
