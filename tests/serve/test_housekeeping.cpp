// SPDX-License-Identifier: GPL-3.0-or-later
#include "folder_lock.hpp"
#include "housekeeping.hpp"
#include "shelf.hpp"
#include "support/folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace fs = std::filesystem;
using namespace stylet::serve;

namespace {

constexpr std::uintmax_t kEnough = 100 * RecordingRoom::kGigabyte;

/// Recordings of 1,000 bytes, each a minute younger than the one before.
struct Housekeeping : testing::Test {
  stylet::test::Folder temporary;
  fs::path folder = temporary.path();

  int made = 0;
  void make(const std::string& name) {
    const fs::path file = stylet::test::write_file(folder / name / "run.h5", std::string(1000, 'x'));
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::minutes(1000 - ++made));
  }
  [[nodiscard]] bool has(const std::string& name) const { return fs::exists(folder / name / "run.h5"); }
  [[nodiscard]] RoomReport look(std::uintmax_t most_bytes, std::uintmax_t free = kEnough) const {
    return make_room(folder, {.most_bytes = most_bytes}, [free](const fs::path&) { return free; });
  }
};

constexpr const char* kFirst = "2026-01-01-120000-e3.5";
constexpr const char* kSecond = "2026-01-02-120000-e3.5";
constexpr const char* kThird = "2026-01-03-120000-e3.5";

}  // namespace

TEST_F(Housekeeping, the_oldest_go_until_the_rest_fit) {
  for (const char* name : {kFirst, kSecond, kThird}) make(name);
  EXPECT_TRUE(look(3000).removed.empty());
  EXPECT_EQ(look(1999).removed, (std::vector<std::string>{kFirst, kSecond}));
  EXPECT_FALSE(fs::exists(folder / kFirst));
  EXPECT_TRUE(has(kThird));
}

TEST_F(Housekeeping, what_a_killed_server_had_not_begun_goes_unless_it_is_new_or_in_use) {
  using stylet::test::write_file;
  for (const char* name : {kFirst, kSecond, kThird}) write_file(folder / name / ".stylet-1-0.part", "half");
  for (const char* name : {kFirst, kSecond})
    fs::last_write_time(folder / name, fs::file_time_type::clock::now() - std::chrono::hours(1));
  const FolderLock in_use(folder / kSecond, FolderLock::Kind::shared);
  look(0);
  EXPECT_EQ(stylet::test::names_in(folder), (std::vector<std::string>{kSecond, kThird}));
}

TEST_F(Housekeeping, without_a_limit_nothing_goes) {
  make(kFirst);
  EXPECT_TRUE(look(0).removed.empty());
  EXPECT_TRUE(has(kFirst));
}

TEST_F(Housekeeping, one_in_use_stays_and_when_no_other_is_left_recording_stops) {
  make(kFirst);
  make(kSecond);
  const FolderLock in_use(folder / kFirst, FolderLock::Kind::shared);
  const RoomReport report = look(1);
  EXPECT_EQ(report.removed, std::vector<std::string>{kSecond});
  EXPECT_TRUE(has(kFirst));
  EXPECT_NE(report.stop.find("--keep"), std::string::npos) << report.stop;
}

TEST_F(Housekeeping, what_the_page_did_not_record_under_its_own_name_is_never_touched) {
  make("my-best-one");
  make("2026-01-01");
  make(kFirst);
  std::ofstream(folder / kFirst / "report.html") << "results of somebody's";
  make(kSecond);
  fs::rename(folder / kSecond, folder / "elsewhere");
  fs::create_directory_symlink(folder / "elsewhere", folder / kSecond);
  const RoomReport report = look(1);
  EXPECT_TRUE(report.removed.empty());
  EXPECT_EQ(report.stop, "");
  for (const char* name : {"my-best-one", "2026-01-01", kFirst, "elsewhere"}) EXPECT_TRUE(has(name)) << name;
}

TEST_F(Housekeeping, a_disk_that_gets_full_is_a_warning_and_a_full_one_stops_recording) {
  const RoomReport well = look(0, RecordingRoom::kGigabyte);
  EXPECT_EQ(well.warning + well.stop, "");
  const RoomReport low = look(0, RecordingRoom::kGigabyte - 1);
  EXPECT_NE(low.warning.find(folder.string()), std::string::npos) << low.warning;
  EXPECT_EQ(low.stop, "");
  EXPECT_NE(look(0, 100'000'000).stop.find("0.1 GB"), std::string::npos);
}

TEST_F(Housekeeping, a_new_name_is_one_it_knows_again) {
  EXPECT_TRUE(Shelf::is_own_name(Shelf(folder).new_name("hole E3.5")));
  EXPECT_TRUE(Shelf::is_own_name(Shelf(folder).new_name("")));
  EXPECT_FALSE(Shelf::is_own_name("2026-01-01-12000x-e3"));
}

TEST_F(Housekeeping, a_lock_ends_with_its_holder) {
  make(kFirst);
  {
    const FolderLock one(folder / kFirst, FolderLock::Kind::shared);
    const FolderLock two(folder / kFirst, FolderLock::Kind::shared);
    EXPECT_TRUE(one.is_held() && two.is_held());
    EXPECT_FALSE(FolderLock(folder / kFirst, FolderLock::Kind::alone).is_held());
  }
  EXPECT_TRUE(FolderLock(folder / kFirst, FolderLock::Kind::alone).is_held());
  EXPECT_FALSE(FolderLock(folder / "none", FolderLock::Kind::alone).is_held());
}
