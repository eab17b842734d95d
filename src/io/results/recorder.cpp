// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorder.hpp"

#include "stylet/core/survive.hpp"

#include <chrono>
#include <utility>

namespace stylet::results {

namespace {
constexpr std::chrono::milliseconds kPeriod{200};  // between flushes; the documented limit is 0.5 s
// Between waits for the disk: what a power cut costs, and little enough that the wait at the end is short.
constexpr std::chrono::seconds kOnDisk{5};
}  // namespace

Recorder::Recorder(RunFileWriter writer)
    : writer_(std::move(writer)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

Recorder::~Recorder() {
  // A run that ends without finish() still writes everything that it recorded.
  const auto ignore = [](const Error&) {};
  if (!closed_)
    survive(
        "the end of the recording", [this] { (void)close(nullptr); }, ignore);
}

Result<> Recorder::write_pending() {
  Pending pending;
  {
    const std::lock_guard lock(mutex_);
    pending.swap(pending_);
  }
  Result<> done = Ok{};
  bool any = false;
  const auto write = [&](const auto& records) {
    any = any || !records.empty();
    if constexpr (requires { records.front().displacement; }) {
      for (const StoredFrame& frame : records)
        if (done.ok()) done = writer_.append_frame(frame);
    } else if (done.ok()) {
      done = writer_.append(std::span(records));
    }
  };
  std::apply([&](const auto&... records) { (write(records), ...); }, pending);
  return done.ok() && any ? writer_.flush() : done;
}

void Recorder::run(const std::stop_token& stop) {
  auto on_disk = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    std::uint64_t asked = 0;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kPeriod, [&] { return asked_ != answered_; });
      asked = asked_;
    }
    bool goes_on = true;
    const auto fail = [&](const Error& why) {
      goes_on = false;
      const std::lock_guard lock(mutex_);
      error_ = why;
    };
    survive(
        "the recording",
        [&] {
          Result<> done = write_pending();
          if (const auto now = std::chrono::steady_clock::now(); done && now - on_disk >= kOnDisk) {
            done = writer_.sync();
            on_disk = now;
          }
          if (!done) fail(done.error());
        },
        fail);
    {
      const std::lock_guard lock(mutex_);
      answered_ = asked;
    }
    answer_.notify_all();
    if (!goes_on) return;
  }
}

void Recorder::write_now(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  const std::uint64_t number = ++asked_;
  wake_.notify_one();
  answer_.wait_for(lock, most, [&] { return answered_ >= number || error_; });
}

Result<> Recorder::close(const Summary* summary) {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  closed_ = true;
  Result<> done = error_ ? Result<>(*error_) : write_pending();
  if (done.ok() && summary != nullptr) done = writer_.append_summary(*summary);
  Result<> closed = writer_.close();
  return done.ok() ? closed : done;
}

}  // namespace stylet::results
