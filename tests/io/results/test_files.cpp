// SPDX-License-Identifier: GPL-3.0-or-later
// Files that appear whole or not at all, and what is left of those of killed processes.
#include "detail/unfinished.hpp"
#include "detail/vtk_messages.hpp"
#include "stylet/io/files.hpp"
#include "stylet/io/remarks.hpp"
#include "support/folder.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkNew.h>
#include <vtkPoints.h>

#include <csignal>

namespace fs = std::filesystem;
using stylet::detail::Unfinished;
using stylet::test::content_of;
using stylet::test::Folder;
using stylet::test::names_in;

namespace stylet {
namespace {

using Names = std::vector<std::string>;

/// Leaves an unfinished file of 12 MB and a folder with a file, as a killed process does.
void leave_behind(const fs::path& folder) {
  const pid_t child = fork();
  if (child == 0) {
    const auto file = Unfinished::create(folder / "big", Unfinished::Kind::file);
    const auto inner = Unfinished::create(folder / "inner", Unfinished::Kind::folder);
    const bool good = file && inner && ::ftruncate(file->descriptor(), 12'000'000) == 0;
    if (good) test::write_file(inner->path() / "a", "half");
    _exit(good ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
}

TEST(WholeFile, replaces_an_earlier_one_and_has_the_usual_permissions) {
  const Folder folder;
  for (const char* content : {"one", "two", ""}) {
    ASSERT_TRUE(write_whole_file(folder / "file", content));
    EXPECT_EQ(content_of(folder / "file"), content);
  }
  const mode_t mask = umask(0);
  umask(mask);
  struct stat about {};
  ASSERT_EQ(stat((folder / "file").c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0666 & ~mask);
  EXPECT_EQ(names_in(folder.path()), Names{"file"});
}

TEST(WholeFile, a_name_may_be_as_long_as_the_disk_permits) {
  const Folder folder;
  const std::string name(255, 'x');
  ASSERT_TRUE(write_whole_file(folder / name, "content"));
  EXPECT_EQ(names_in(folder.path()), Names{name});
}

TEST(WholeFile, that_does_not_fit_leaves_the_earlier_one) {
  const Folder folder;
  ASSERT_TRUE(write_whole_file(folder / "file", "earlier"));
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto done = write_whole_file(folder / "file", std::string(2000, 'x'));
    _exit(!done && done.error().kind == ErrorKind::failed ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(content_of(folder / "file"), "earlier");
  EXPECT_EQ(names_in(folder.path()), Names{"file"});
}

TEST(WholeFile, a_device_is_written_and_not_replaced) {
  const auto done = write_whole_file("/dev/full", "content");
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().what.find("no space is left"), std::string::npos);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_TRUE(write_whole_file("/dev/null", "content"));
}

TEST(Unfinished, of_killed_processes_go_with_a_remark_when_the_next_one_writes) {
  const Folder folder;
  leave_behind(folder.path());
  ASSERT_EQ(names_in(folder.path()).size(), 2U);
  const Names foreign{".stylet-notes.part", "notes.part"};
  for (const std::string& name : foreign) test::write_file(folder / name, "mine");
  Names remarks;
  receive_remarks([&](const std::string& remark) { remarks.push_back(remark); });
  ASSERT_TRUE(write_whole_file(folder / "file", "content"));
  receive_remarks({});
  EXPECT_EQ(names_in(folder.path()), (Names{foreign[0], "file", foreign[1]}));
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks[0].find("12 MB"), std::string::npos) << remarks[0];
}

TEST(Unfinished, in_use_by_another_process_stays) {
  const Folder folder;
  auto mine = test::value_of(Unfinished::create(folder / "file", Unfinished::Kind::file));
  const pid_t child = fork();
  // Under another name, because this process and so its child have looked at the folder already.
  if (child == 0) _exit(write_whole_file(folder / "." / "other", "content") ? 0 : 1);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(fs::exists(mine.path()));
  ASSERT_TRUE(mine.finish());
  EXPECT_EQ(names_in(folder.path()), (Names{"file", "other"}));
}

TEST(Unfinished, is_removed_with_its_object) {
  const Folder folder;
  for (const auto kind : {Unfinished::Kind::file, Unfinished::Kind::folder}) {
    const auto made = Unfinished::create(folder / "new", kind);
    ASSERT_TRUE(made);
    EXPECT_EQ(names_in(folder.path()).size(), 1U);
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

/// Lets no further file be opened as long as it exists.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    EXPECT_EQ(getrlimit(RLIMIT_NOFILE, &before_), 0);
    const int next = ::dup(STDERR_FILENO);
    ::close(next);
    const rlimit none{static_cast<rlim_t>(next), before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  }
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoMoreFiles(const NoMoreFiles&) = delete;
  NoMoreFiles& operator=(const NoMoreFiles&) = delete;

 private:
  rlimit before_{};
};

TEST(Unfinished, is_removed_where_nothing_more_can_be_opened) {
  const Folder folder;
  std::optional made = test::value_of(Unfinished::create(folder / "new", Unfinished::Kind::file));
  ASSERT_EQ(names_in(folder.path()).size(), 1U);
  {
    // Its own descriptor stays open until the end, so that this one is the next.
    const NoMoreFiles none;
    made.reset();
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(Unfinished, that_has_its_name_is_finished_with_a_remark_where_the_disk_does_not_confirm_it) {
  const Folder folder;
  std::vector<std::string> remarks;
  receive_remarks([&](const std::string& text) { remarks.push_back(text); });
  auto made = test::value_of(Unfinished::create(folder / "new", Unfinished::Kind::file));
  {
    const NoMoreFiles none;
    EXPECT_TRUE(made.finish());
  }
  receive_remarks({});
  EXPECT_EQ(names_in(folder.path()), Names{"new"});
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks.front().find("does not confirm its name"), std::string::npos) << remarks.front();
}

TEST(Folders, are_made_with_those_above_them) {
  const Folder folder;
  EXPECT_TRUE(make_folder(folder / "a/b/c/"));
  EXPECT_TRUE(fs::is_directory(folder / "a/b/c"));
  EXPECT_TRUE(make_folder(folder / "a/b"));
  test::write_file(folder / "file", "in the way");
  EXPECT_FALSE(make_folder(folder / "file/d"));
  EXPECT_FALSE(check_writable(folder / "none"));
  EXPECT_TRUE(check_writable(folder.path()));
  EXPECT_EQ(names_in(folder.path()), (Names{"a", "file"}));
}

TEST(Vtk, says_nothing_on_the_terminal_once_files_are_written) {
  const vtkNew<vtkPoints> points;
  detail::silence_vtk();
  ::testing::internal::CaptureStderr();
  vtkGenericWarningMacro("a warning");
  vtkErrorWithObjectMacro(points, "an error");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace stylet
