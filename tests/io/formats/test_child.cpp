// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/guard.hpp"
#include "files.hpp"
#include "mask_files.hpp"

#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <thread>

using namespace stylet;
using namespace stylet::detail;
using namespace stylet::test;

namespace {

/// The result of guarded() for a parser with this behaviour.
Result<TetMesh> parse(const std::function<Result<TetMesh>()>& parser) { return guarded<TetMesh>("case.msh", parser); }

}  // namespace

TEST(Child, results_of_every_kind_come_back_unchanged) {
  const auto contours = value_of(guarded<ContourSet>("x", [] { return two_organs(); }));
  EXPECT_EQ(largest_difference(contours, two_organs()), 0.0);
  const auto image = value_of(guarded<LabelImage>("x", []() -> Result<LabelImage> {
    LabelImage i;
    i.size = {2, 1, 1};
    i.labels = {7, 65535};
    i.names = {{7, "Prostate"}};
    i.origin = Vec3(1, 2, 3);
    return i;
  }));
  EXPECT_EQ(image.labels, (std::vector<std::uint16_t>{7, 65535}));
  EXPECT_EQ(image.names.at(7), "Prostate");
  EXPECT_EQ(image.origin, Vec3(1, 2, 3));
  const auto error = guarded<TetMesh>("x", []() -> Result<TetMesh> { return failure("a", "b", "c"); });
  ASSERT_FALSE(error.ok());
  EXPECT_EQ(error.error().kind, ErrorKind::failed);
  EXPECT_EQ(error.error().message(), "a: b. c");
}

TEST(Child, a_large_result_comes_back_whole) {
  const auto mesh = value_of(parse([]() -> Result<TetMesh> {
    TetMesh m;
    m.nodes.assign(2000000, Vec3(1, 2, 3));
    return m;
  }));
  EXPECT_EQ(mesh.nodes.size(), 2000000U);
  EXPECT_EQ(mesh.nodes.back(), Vec3(1, 2, 3));
}

TEST(Child, a_crash_becomes_an_input_error_with_the_last_words) {
  expect_refused(parse([]() -> Result<TetMesh> {
                   std::fputs("first line\nbad element 17\n", stderr);
                   std::fflush(stderr);
                   std::raise(SIGSEGV);
                   return TetMesh{};
                 }),
                 {"case.msh", "the parser stopped (signal 11", "bad element 17"});
  expect_refused(parse([]() -> Result<TetMesh> { std::abort(); }), {"signal 6"});
}

TEST(Child, exit_and_exceptions_become_input_errors) {
  expect_refused(parse([]() -> Result<TetMesh> { std::_Exit(7); }), {"exit status 7"});
  expect_refused(parse([]() -> Result<TetMesh> { std::_Exit(0); }), {"gave up"});
  expect_refused(parse([]() -> Result<TetMesh> { throw std::runtime_error("odd number"); }), {"odd number"});
  expect_refused(parse([]() -> Result<TetMesh> { throw 17; }), {"unknown exception"});
}

TEST(Child, memory_without_end_becomes_an_input_error) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer needs unlimited address space";
#endif
  expect_refused(parse([]() -> Result<TetMesh> {
                   TetMesh m;
                   m.nodes.resize(std::size_t{1} << 32);
                   return m;
                 }),
                 {"needs more memory"});
}

TEST(Child, the_limit_grows_with_what_a_file_unpacks_to) {
  const Folder folder;
  Mask mask;
  mask.size = {200, 200, 500};
  mask.labels.assign(20000000, 1);  // is compressed to about 20 kB
  const double plain_s = 5.0 + 2.03 * 20.0;
  EXPECT_NEAR(limits_for(write_file(folder / "m.nii", nifti(mask))).cpu_s, plain_s, 0.1);
  for (const auto& [name, bytes] : {std::pair<const char*, std::string>{"m.nii.gz", gzipped(nifti(mask))},
                                    {"m.nrrd", nrrd(mask, "gzip")},
                                    {"m.mha", metaimage(mask, true)}}) {
    EXPECT_NEAR(limits_for(write_file(folder / name, bytes)).cpu_s, 5.0 + 0.03 * 20.0, 0.1) << name;
  }
  write_file(folder / "m.raw", std::string(mask.labels.begin(), mask.labels.end()));
  EXPECT_NEAR(limits_for(write_file(folder / "m.mhd", metaimage(mask, false, "m.raw"))).cpu_s, plain_s, 0.1);
}

TEST(Child, a_forged_size_does_not_buy_minutes) {
  const Folder folder;
  std::string bytes = gzipped(nifti(Mask()));
  bytes.replace(bytes.size() - 4, 4, "\xff\xff\xff\xff");
  EXPECT_LT(limits_for(write_file(folder / "m.nii.gz", bytes)).cpu_s, 5.1);
  bytes.insert(bytes.size() - 4, std::string(100000, 'x'));
  EXPECT_LT(limits_for(write_file(folder / "m.nii.gz", bytes)).cpu_s, 10.0);
  bytes.insert(bytes.size() - 4, std::string(9900000, 'x'));
  EXPECT_NEAR(limits_for(write_file(folder / "m.nii.gz", bytes)).cpu_s, 5.0 + 20.0 + 100.0, 0.1);
}

TEST(Child, the_limit_of_a_folder_grows_with_its_entries) {
  const Folder folder;
  const double empty_s = limits_for(folder.path()).cpu_s;
  for (int n = 0; n < 50; ++n) write_file(folder / std::to_string(n), "x");
  EXPECT_NEAR(limits_for(folder.path()).cpu_s - empty_s, 0.1, 1e-9);
}

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
  EXPECT_EQ(run_in_child(sleep, {.cpu_s = 10.0, .wall_s = 0.3}).end, ChildEnd::timed_out);
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

TEST(Child, many_in_a_row_leave_no_process_and_no_open_file) {
  const auto open_files = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator{});
  };
  const auto before = open_files();
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(parse([]() -> Result<TetMesh> { return TetMesh{}; }).ok());
  EXPECT_EQ(open_files(), before);
}
