// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorder.hpp"

#include <chrono>
#include <utility>

namespace stylet::results {

namespace {
constexpr std::chrono::milliseconds kPeriod{200};  // between flushes; the documented limit is 0.5 s
}

Recorder::Recorder(RunFileWriter writer)
    : writer_(std::move(writer)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

Recorder::~Recorder() {
  // A run that ends without finish() still writes everything that it recorded.
  if (!closed_) (void)close(nullptr);
}

Result<> Recorder::add_step(const Step& step) {
  const std::lock_guard lock(mutex_);
  if (error_) return *error_;
  steps_.push_back(step);
  return Ok{};
}

Result<> Recorder::add_frame(StoredFrame frame) {
  const std::lock_guard lock(mutex_);
  if (error_) return *error_;
  frames_.push_back(std::move(frame));
  return Ok{};
}

Result<> Recorder::add_event(const Event& event) {
  const std::lock_guard lock(mutex_);
  if (error_) return *error_;
  events_.push_back(event);
  return Ok{};
}

Result<> Recorder::add_probe_move(const ProbeMove& move) {
  const std::lock_guard lock(mutex_);
  if (error_) return *error_;
  moves_.push_back(move);
  return Ok{};
}

Result<> Recorder::add_act(const SeedAct& act) {
  const std::lock_guard lock(mutex_);
  if (error_) return *error_;
  acts_.push_back(act);
  return Ok{};
}

Result<> Recorder::add_dose(const RecordedScore& dose) {
  const std::lock_guard lock(mutex_);
  if (error_) return *error_;
  doses_.push_back(dose);
  return Ok{};
}

Result<> Recorder::write_pending() {
  std::vector<Step> steps;
  std::vector<StoredFrame> frames;
  std::vector<Event> events;
  std::vector<ProbeMove> moves;
  std::vector<SeedAct> acts;
  std::vector<RecordedScore> doses;
  {
    const std::lock_guard lock(mutex_);
    steps.swap(steps_);
    frames.swap(frames_);
    events.swap(events_);
    moves.swap(moves_);
    acts.swap(acts_);
    doses.swap(doses_);
  }
  if (steps.empty() && frames.empty() && events.empty() && moves.empty() && acts.empty() && doses.empty()) return Ok{};
  if (auto done = writer_.append_steps(steps); !done) return done;
  for (const StoredFrame& frame : frames) {
    if (auto done = writer_.append_frame(frame); !done) return done;
  }
  if (!events.empty()) {
    if (auto done = writer_.append_events(events); !done) return done;
  }
  if (!moves.empty()) {
    if (auto done = writer_.append_probe_moves(moves); !done) return done;
  }
  if (!acts.empty() || !doses.empty()) {
    if (auto done = writer_.append_seeds(acts, doses); !done) return done;
  }
  return writer_.flush();
}

void Recorder::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kPeriod, [] { return false; });
    }
    if (auto done = write_pending(); !done) {
      const std::lock_guard lock(mutex_);
      error_ = done.error();
      return;
    }
  }
}

Result<> Recorder::close(const Summary* summary) {
  thread_.request_stop();
  thread_.join();
  closed_ = true;
  Result<> done = error_ ? Result<>(*error_) : write_pending();
  if (done.ok() && summary != nullptr) done = writer_.append_summary(*summary);
  Result<> closed = writer_.close();
  return done.ok() ? closed : done;
}

}  // namespace stylet::results
