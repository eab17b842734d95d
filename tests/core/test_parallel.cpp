// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace stylet {
namespace {

TEST(Parallel, EveryPieceIsDoneOnceOnAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 7}) {
    set_worker_threads(threads);
    for (const std::size_t count : {0, 1, 5, 1000}) {
      std::vector<int> done(count, 0);
      for_each_in_parallel(count, [&](std::size_t i) { ++done[i]; });
      EXPECT_EQ(done, std::vector<int>(count, 1));
    }
  }
  set_worker_threads(0);
}

TEST(Parallel, ProgressComesInTheCallersThreadAndEndsAtOne) {
  set_worker_threads(3);
  const auto caller = std::this_thread::get_id();
  double last = 0.0;
  for_each_in_parallel(
      200, [](std::size_t) {},
      [&](std::string_view stage, double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(stage, "work");
        EXPECT_GE(fraction, last);
        last = fraction;
      },
      "work");
  EXPECT_EQ(last, 1.0);
  set_worker_threads(0);
}

TEST(Parallel, AnExceptionReachesTheCallerAndEndsTheWork) {
  for (const int threads : {1, 4}) {
    set_worker_threads(threads);
    std::atomic<int> done = 0;
    EXPECT_THROW(for_each_in_parallel(1000,
                                      [&](std::size_t i) {
                                        if (i == 10) throw std::runtime_error("no");
                                        ++done;
                                      }),
                 std::runtime_error);
    // With one thread, work stops at once. With several, the others may have finished before the one that throws gets
    // its turn.
    if (threads == 1) {
      EXPECT_EQ(done, 10);
    }
  }
  set_worker_threads(0);
}

}  // namespace
}  // namespace stylet
