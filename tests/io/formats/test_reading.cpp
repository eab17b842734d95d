// SPDX-License-Identifier: GPL-3.0-or-later
// The program that reads files of unknown origin: a parser that is broken or taken over can do no harm.
#include "files.hpp"
#include "mask_files.hpp"
#include "misbehaviour.hpp"
#include "reading/ask.hpp"
#include "reading/find_program.hpp"
#include "stylet/core/version.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdlib>

using namespace stylet;
using namespace stylet::detail;
using namespace stylet::test;

namespace {

/// Sets the variable that names the reading program, for the life of this object.
class Reader {
 public:
  explicit Reader(const std::string& program = MISBEHAVING_READER) { ::setenv("STYLET_READER", program.c_str(), 1); }
  ~Reader() { ::unsetenv("STYLET_READER"); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

ChildOutcome end_within(const std::string& how, const ChildLimits& limits) {
  WireWriter arguments, wire;
  std::string path = "x", way = how;
  arguments(path, way);
  ReadingRequest request{this_release(),         ::getpid(),     limits.cpu_s, limits.memory_bytes,
                         std::string(kEnd.name), arguments.bytes};
  wire(request);
  return run_program(MISBEHAVING_READER, wire.bytes, limits);
}

std::size_t open_files() {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator{}));
}

}  // namespace

TEST(Reading, answers_come_back_unchanged) {
  const Reader reader;
  EXPECT_EQ(largest_difference(value_of(ask(kEchoContours, "x", two_organs())), two_organs()), 0.0);
  LabelImage image;
  image.size = {2, 1, 1};
  image.labels = {7, 65535};
  image.names = {{7, "Prostate"}};
  image.origin = Vec3(1, 2, 3);
  const LabelImage back = value_of(ask(kEchoImage, "x", image));
  EXPECT_EQ(back.labels, image.labels);
  EXPECT_EQ(back.names, image.names);
  EXPECT_EQ(back.origin, image.origin);
  const auto error = ask(kEnd, "x", "error");
  ASSERT_FALSE(error.ok());
  EXPECT_EQ(error.error().kind, ErrorKind::failed);
  EXPECT_EQ(error.error().message(), "a: b. c");
}

TEST(Reading, a_large_answer_comes_back_whole) {
  const Reader reader;
  const TetMesh mesh = value_of(ask(kManyNodes, "x", 2));
  EXPECT_EQ(mesh.nodes.size(), 2000000U);
  EXPECT_EQ(mesh.nodes.back(), Vec3(1, 2, 3));
}

TEST(Reading, any_end_of_the_program_becomes_an_input_error) {
  const Reader reader;
  expect_refused(ask(kEnd, "case.msh", "words and a crash"), {"case.msh", "the parser stopped (signal 11"});
  expect_refused(ask(kEnd, "case.msh", "abort"), {"signal 6"});
  expect_refused(ask(kEnd, "case.msh", "status 7"), {"exit status 7"});
  expect_refused(ask(kEnd, "case.msh", "status 0"), {"gave up"});
  expect_refused(ask(kEnd, "case.msh", "exception"), {"case.msh", "gave up"});
  expect_refused(ask(kEnd, "case.msh", "number"), {"case.msh", "gave up"});
  expect_refused(ask(kManyNodes, "case.msh", 1000), {"needs more memory"});
}

TEST(Reading, a_program_that_does_not_end_is_ended) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(end_within("loop", {.cpu_s = 1.0, .wall_s = 30.0}).end, ChildEnd::timed_out);
  EXPECT_EQ(end_within("sleep", {.cpu_s = 10.0, .wall_s = 0.5}).end, ChildEnd::overdue);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 25.0);
}

TEST(Reading, chatter_is_caught_even_when_it_is_long) {
  const ChildOutcome outcome = end_within("chatter", {});
  EXPECT_EQ(outcome.end, ChildEnd::finished);
  EXPECT_LT(outcome.noise.size(), 100000U);
  EXPECT_NE(outcome.noise.find("warning 99999"), std::string::npos);
}

TEST(Reading, a_parser_may_read_and_nothing_else) {
  const Reader reader;
  const Folder folder;
  const fs::path file = write_file(folder / "case", "content");
  for (const char* allowed : {"nothing", "read"}) EXPECT_EQ(value_of(ask(kAttempt, file, allowed)), 0) << allowed;
  for (const char* refused : {"socket",
                              "local socket",
                              "write",
                              "read and write",
                              "append",
                              "create",
                              "truncate by opening",
                              "file without a name",
                              "truncate",
                              "unlink",
                              "rename",
                              "link",
                              "symbolic link",
                              "folder",
                              "pipe",
                              "mode",
                              "exec",
                              "exec of an open file",
                              "fork",
                              "clone",
                              "ptrace",
                              "ptrace of the parent",
                              "signal to the parent",
                              "signal to a thread of the parent",
                              "memory of the parent",
                              "ring of requests",
                              "new rights",
                              "limits"}) {
    EXPECT_NE(value_of(ask(kAttempt, file, refused)), 0) << refused;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator{}), 1);
  EXPECT_EQ(fs::file_size(file), 7U);
}

TEST(Reading, a_parser_may_use_a_public_reader) {
  const Reader reader;
  EXPECT_TRUE(value_of(ask(kReadsItself, "x")));
}

TEST(Reading, many_in_a_row_leave_no_process_and_no_open_file) {
  const Reader reader;
  const auto before = open_files();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(value_of(ask(kAttempt, "x", "nothing")), 0);
  EXPECT_EQ(open_files(), before);
}

TEST(Reading, a_program_that_is_missing_or_of_another_version_is_said) {
  {
    const Reader reader("/nowhere/stylet-reader");
    const auto missing = ask(kEnd, "x", "nothing");
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().kind, ErrorKind::failed);
    EXPECT_NE(missing.error().message().find("STYLET_READER"), std::string::npos);
  }
  EXPECT_TRUE(find_reading_program().ok()) << "stylet-reader is beside this program";
  WireWriter wire;
  ReadingRequest request{"0.0.1", ::getpid(), 5.0, 1U << 30, std::string(kEnd.name), {}};
  wire(request);
  const ChildOutcome outcome = run_program(MISBEHAVING_READER, wire.bytes, {});
  ASSERT_EQ(outcome.end, ChildEnd::finished);
  const Result<bool> answer = from_bytes<bool>(outcome.result);
  ASSERT_FALSE(answer.ok());
  EXPECT_NE(answer.error().message().find(this_release()), std::string::npos);
}

TEST(Reading, the_limit_grows_with_what_a_file_unpacks_to) {
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

TEST(Reading, a_forged_size_does_not_buy_minutes) {
  const Folder folder;
  std::string bytes = gzipped(nifti(Mask()));
  bytes.replace(bytes.size() - 4, 4, "\xff\xff\xff\xff");
  EXPECT_LT(limits_for(write_file(folder / "m.nii.gz", bytes)).cpu_s, 5.1);
  bytes.insert(bytes.size() - 4, std::string(100000, 'x'));
  EXPECT_LT(limits_for(write_file(folder / "m.nii.gz", bytes)).cpu_s, 10.0);
  bytes.insert(bytes.size() - 4, std::string(9900000, 'x'));
  EXPECT_NEAR(limits_for(write_file(folder / "m.nii.gz", bytes)).cpu_s, 5.0 + 20.0 + 100.0, 0.1);
}

TEST(Reading, the_limit_of_a_folder_grows_with_its_entries) {
  const Folder folder;
  const double empty_s = limits_for(folder.path()).cpu_s;
  for (int n = 0; n < 50; ++n) write_file(folder / std::to_string(n), "x");
  EXPECT_NEAR(limits_for(folder.path()).cpu_s - empty_s, 0.1, 1e-9);
}
