// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/child.hpp"
#include "files.hpp"

#include <chrono>
#include <thread>

using namespace stylet;
using namespace stylet::detail;
using namespace stylet::test;

TEST(Child, an_endless_loop_ends_at_the_limit) {
  const auto spin = []() -> std::string {
    std::uint64_t n = 1;
    while (n != 0) n = n * 6364136223846793005ULL | 1;  // never 0, which no compiler can prove
    return std::to_string(n);
  };
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run_in_child(spin, {.cpu_s = 1.0, .wall_s = 30.0}).end, ChildEnd::timed_out);
  const auto sleep = []() -> std::string {
    std::this_thread::sleep_for(std::chrono::hours(1));
    return {};
  };
  EXPECT_EQ(run_in_child(sleep, {.cpu_s = 10.0, .wall_s = 0.3}).end, ChildEnd::overdue);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20.0);
}

TEST(Child, chatter_is_caught_even_when_it_is_long) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  std::printf("parent's own ");
  const ChildOutcome outcome = run_in_child(
      []() -> std::string {
        for (int i = 0; i < 100000; ++i) std::printf("warning %d\n", i);
        std::fflush(stdout);
        return "done";
      },
      {});
  EXPECT_EQ(outcome.end, ChildEnd::finished);
  EXPECT_EQ(outcome.result, "done");
  EXPECT_LT(outcome.noise.size(), 100000U);
  EXPECT_NE(outcome.noise.find("warning 99999"), std::string::npos);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "parent's own ");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Child, it_cannot_write_files) {
  const Folder folder;
  run_in_child(
      [&]() -> std::string {
        write_file(folder / "written", std::string(100000, 'x'));
        return {};
      },
      {});
  std::error_code none;
  EXPECT_TRUE(!fs::exists(folder / "written") || fs::file_size(folder / "written", none) == 0);
}
