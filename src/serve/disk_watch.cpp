// SPDX-License-Identifier: GPL-3.0-or-later
#include "disk_watch.hpp"

#include "stylet/core/survive.hpp"

#include <utility>

namespace stylet::serve {

DiskWatch::DiskWatch(Look look, std::function<void(const std::string&)> say, std::chrono::milliseconds every)
    : look_(std::move(look)),
      say_(std::move(say)),
      every_(every),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void DiskWatch::set_recording(bool is_recording) {
  {
    const std::lock_guard lock(mutex_);
    is_recording_ = is_recording;
    report_ = {};
    ++turn_;
  }
  wake_.notify_all();
}

RoomReport DiskWatch::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void DiskWatch::tell(const RoomReport& before, const RoomReport& now) const {
  if (!say_) return;
  for (const std::string& name : now.removed)
    say_("The recording " + name + " was removed to keep all recordings within their limit (--keep).");
  if (before.warning.empty() && !now.warning.empty()) say_("Recordings may stop soon: " + now.warning + ".");
}

void DiskWatch::run(const std::stop_token& stop) {
  RoomReport told;
  int seen = 0;
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait(lock, stop, [&] { return is_recording_; });
    if (stop.stop_requested()) return;
    seen = turn_;
    lock.unlock();
    RoomReport now;
    survive(
        "the folder of recordings",
        [&] {
          now = look_();
          tell(told, now);
          told = now;
        },
        [&](const Error& why) { now.warning = "the free space is not known: " + why.what; });
    lock.lock();
    if (seen == turn_) report_ = std::move(now);
    wake_.wait_for(lock, stop, every_, [&] { return seen != turn_; });
  }
}

}  // namespace stylet::serve
