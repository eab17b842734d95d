// SPDX-License-Identifier: GPL-3.0-or-later
#include "live_run.hpp"

#include "wall_clock.hpp"
#include "wire.hpp"

#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <array>

namespace stylet::serve {

namespace {

constexpr double kHalfSeed_mm = 2.25;      ///< distance from the tip to the centre of a seed that is pushed out
constexpr std::size_t kSamplesAtRest = 4;  ///< samples of the curve in a picture that says nothing new

}  // namespace

LiveRun::LiveRun(const OpenModel& open, std::size_t insertion, double recorded_frames_per_s)
    : model_(open.model),
      plan_(open.model->insertions()[insertion]),
      seeds_(open.model),
      frames_(open.model, recorded_frames_per_s),
      view_(open),
      force_room_(Snapshot::kForces),
      step_room_(1024) {}

void LiveRun::set_field(std::shared_ptr<const DisplayField> field) {
  view_.set_field(std::move(field));
  if (seen_) view_.owe();
}

Result<std::unique_ptr<LiveRun>> LiveRun::start(const OpenModel& open, std::size_t insertion,
                                                const std::filesystem::path& folder, const RunnerSettings& settings,
                                                double recorded_frames_per_s, std::unique_ptr<Device> other,
                                                const RecordedPlan* plan_of_seeds,
                                                const std::function<void(const std::string&)>& say) {
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
  auto body = SimulationSteppable::create(open.model, insertion, run->seeds_.probe());
  if (!body) return body.error();
  const std::vector<std::string> remarks = (*body)->remarks();
  auto runner = RealtimeRunner::create(*std::move(body), std::make_unique<SharedDevice>(std::move(device)), kept);
  if (!runner) return runner.error();
  run->runner_ = std::move(*runner);

  RunInfo info = open.model->info(insertion);
  Scenario scenario = open.model->scenario();
  scenario.insertions = {scenario.insertions[insertion]};  // only the insertion that is recorded
  info.scenario_text = to_toml(scenario);
  info.warnings = open.warnings();
  for (const std::string& remark : remarks) {
    info.warnings.push_back(remark);
    if (say) say(remark);
  }
  run->recording_.begin(folder, info, open.model->mesh(), plan_of_seeds);
  if (auto started = run->runner_->start(); !started) return started.error();
  return run;
}

void LiveRun::record_implant(const LiveImplant& implant, bool score_is_current) {
  if (recording_.add(implant, score_is_current, time_s_)) record_next_picture();
}

void LiveRun::pump(const std::function<void(const Event&)>& tell) {
  while (const std::size_t count = runner_->take_steps(step_room_)) {
    for (const Step& step : std::span(step_room_).first(count)) {
      recording_.add(step);
      curve_.add(step);
    }
    time_s_ = step_room_[count - 1].time_s;
  }
  curve_.thin();

  const std::vector<std::string>& regions = model_->mesh().regions;
  std::array<EventSnapshot, 32> events;
  while (const std::size_t count = runner_->take_events(events)) {
    for (const EventSnapshot& e : std::span(events).first(count)) {
      const std::string region = e.region < 0 ? std::string() : regions[static_cast<std::size_t>(e.region)];
      const Event event{e.kind, e.time_s, e.depth_mm, e.force_N, region};
      recording_.add(event);
      tell(event);
      record_next_picture();
    }
  }
}

std::shared_ptr<const LiveFrame> LiveRun::picture(bool whole_curve) {
  const bool fresh = runner_->fetch_snapshot();
  seen_ = seen_ || fresh;
  if (fresh) {
    news_.owe();
    view_.owe();
  }
  // While paused there is no fresh snapshot, but its displacement may still be due, and a viewer that has just
  // connected needs the picture again.
  const bool due = view_.is_due();
  if (!news_.is_owed() && !whole_curve && !due) return nullptr;
  const Snapshot& s = runner_->snapshot();
  if (fresh) foretell_seed(s);
  const std::span<const TissueForce> forces = tissue_forces(s, force_room_);
  if (view_.has_field()) {
    view_.set(forces);
    if (recording_.is_on() && fresh && s.step.time_s > 0.0 && frames_.is_due(s))
      frames_.record(s, forces, view_.field(), view_.load(), recording_);
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
  for (const Snapshot::RestingShape& shape : std::span(s.resting).first(static_cast<std::size_t>(s.resting_count))) {
    for (const Triple& point : shape)
      for (const double value : point) frame->resting.push_back(static_cast<float>(value));
  }
  frame->tip_error = s.tip_error;
  frame->contacts.assign(s.contacts.begin(), s.contacts.begin() + s.contact_count);
  if (due) view_.compute(forces, seeds_);
  frame->left_out_N = view_.left_out_N() + s.forces_left_out_N;
  const bool has_moved = view_.has_moved();
  const FrameNews::Verdict verdict = news_.judge(*frame, has_moved || whole_curve, wall_clock_s());
  if (verdict == FrameNews::Verdict::nothing) return nullptr;
  frame->is_news = verdict == FrameNews::Verdict::news;
  if (has_moved || (view_.has_field() && whole_curve)) set_displacement(*frame, view_.tell());
  frame->curve = curve_.take(whole_curve);
  if (!frame->is_news) wire::thin(frame->curve, kSamplesAtRest);
  if (const std::int64_t lost = s.counters.dropped_steps; lost > 0)
    recording_.lacks(fmt::format("{} steps were not recorded: the disk or this machine is too slow", lost));
  return frame;
}

void LiveRun::show_to(Companion& companion) {
  runner_->fetch_device();
  if (!seen_) return;
  companion.show(runner_->snapshot(), runner_->device_snapshot());
  if (view_.take_anew()) companion.show(view_.shown());
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

void LiveRun::foretell_seed(const Snapshot& now) {
  const Step& step = now.step;
  const bool in_tissue =
      step.inserted_mm > 0.0 && step.tip_state != TipState::air && step.tip_state != TipState::exited;
  if (!in_tissue) return seeds_.foretell(std::nullopt);
  const Vec3 tip = vec3(now.centreline.back());
  const Vec3 axis = (tip - vec3(now.centreline[now.centreline.size() - 2])).normalized();
  const double length = model_->scenario().needle.length_mm + kHalfSeed_mm;
  const Vec3 straight = step.base.origin + length * (step.base.rotation * Vec3::UnitZ());
  seeds_.foretell(SeedForecast::Places{tip + kHalfSeed_mm * axis, straight});
}

std::vector<std::string> LiveRun::inside() const {
  const Snapshot& s = runner_->snapshot();
  std::vector<std::string> names;
  for (const std::int16_t region : std::span(s.regions).first(static_cast<std::size_t>(s.region_count)))
    names.push_back(model_->mesh().regions[static_cast<std::size_t>(region)]);
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
