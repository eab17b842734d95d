// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace stylet {
namespace {

TEST(Parallel, every_piece_is_done_once_on_any_number_of_threads) {
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

TEST(Parallel, progress_comes_in_the_callers_thread_and_ends_at_one) {
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

TEST(Parallel, an_exception_reaches_the_caller_and_ends_the_work) {
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
