// SPDX-License-Identifier: GPL-3.0-or-later
#include "thread_setup.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <mutex>

#if defined(__linux__)
#include <sys/prctl.h>
#endif

namespace stylet {

namespace {

std::mutex mutex;
int holders = 0;
bool is_future_locked = false;  // memory that is allocated from now on is locked, too

}  // namespace

LockedMemory::LockedMemory(bool wanted) {
  if (!wanted) return;
  const std::scoped_lock lock(mutex);
  if (holders == 0 || !is_future_locked) {
    // Future allocations are locked only if there is no limit on locked memory: beyond a limit, allocations would fail
    // anywhere in the process.
    rlimit limit{};
    const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
    if (mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) != 0) {
      error_ = errno;
      return;
    }
    is_future_locked = unlimited;
  }
  ++holders;
  held_ = true;
}

LockedMemory::~LockedMemory() {
  if (!held_) return;
  const std::scoped_lock lock(mutex);
  if (--holders == 0) munlockall();
}

void request_realtime_scheduling(int priority, ThreadRights& rights) {
  sched_param param{};
  param.sched_priority = std::clamp(priority, sched_get_priority_min(SCHED_FIFO), sched_get_priority_max(SCHED_FIFO));
  rights.scheduling_error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
  rights.realtime_scheduling = rights.scheduling_error == 0;
  rights.priority = rights.realtime_scheduling ? param.sched_priority : 0;
}

void prepare_thread() {
  // Half a megabyte is several times the stack that a step uses. It is volatile so that the writes are not optimised
  // away.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): written below, a page at a time
  std::array<volatile char, std::size_t{512} * 1024> stack;
  constexpr std::size_t page = 4096;
  for (std::size_t k = 0; k < stack.size(); k += page) stack[k] = 0;
#if defined(__linux__)
  // By default Linux may wake an ordinary thread up to 50 µs late to save power; request exact timers.
  prctl(PR_SET_TIMERSLACK, 1ul, 0ul, 0ul, 0ul);
#endif
}

void yield_to_others() {
#if defined(__linux__)
  const sched_param ordinary{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);  // the starting thread may be a real-time thread
  constexpr int nice = 10;
  setpriority(PRIO_PROCESS, 0, nice);  // on Linux, 0 means this thread only
#endif
}

std::string ThreadRights::describe() const {
  const auto refusal = [](int error) {
    // strerror is not thread-safe, so the two possible errors have texts of their own.
    if (error == EPERM) return std::string("not permitted");
    if (error == ENOMEM) return std::string("more memory than may be locked");
    return fmt::format("error {}", error);
  };
  std::string text = realtime_scheduling     ? fmt::format("real-time scheduling with priority {}", priority)
                     : scheduling_error != 0 ? "ordinary scheduling (" + refusal(scheduling_error) + ")"
                                             : std::string("ordinary scheduling");
  text += memory_locked       ? ", memory locked"
          : memory_error != 0 ? ", memory not locked (" + refusal(memory_error) + ")"
                              : ", memory not locked";
  text += denormals_flushed ? ", denormal numbers flushed" : ", denormal numbers not flushed";
  return text;
}

}  // namespace stylet
