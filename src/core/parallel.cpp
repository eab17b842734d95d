// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/parallel.hpp"

#include "core/clock.hpp"
#include "stylet/core/survive.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace stylet {
namespace {

std::atomic<int> most_threads = 0;

/// [ns] Processor time of the threads that have ended and were started for this one.
thread_local std::int64_t helped_ns = 0;

}  // namespace

void set_worker_threads(int most) { most_threads = most; }

void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work, const Progress& progress,
                          std::string_view stage) {
  std::atomic<std::size_t> next = 0;
  std::atomic<std::int64_t> by_helpers_ns = 0;
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto go = [&](bool is_caller) {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        if (is_caller) report(progress, stage, static_cast<double>(i) / static_cast<double>(count));
        work(i);
      } catch (...) {
        const std::scoped_lock lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = count;
      }
    }
  };
  const auto cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t threads = most_threads > 0 ? static_cast<std::size_t>(most_threads) : cores;
  {
    std::vector<std::jthread> helpers;
    for (std::size_t k = 1; k < std::min(threads, count); ++k) {
      // Where the system provides no further thread, those that are there do the work.
      if (!survive(
              "a thread of its own",
              [&] {
                helpers.emplace_back([&] {
                  go(false);
                  by_helpers_ns += thread_cpu_ns() + helped_ns;
                });
              },
              [](const Error&) {}))
        break;
    }
    go(true);
  }
  helped_ns += by_helpers_ns;
  if (thrown) std::rethrow_exception(thrown);
  report(progress, stage, 1.0);
}

double work_seconds() { return 1e-9 * static_cast<double>(thread_cpu_ns() + helped_ns); }

}  // namespace stylet
