// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl/drop_log.hpp"

#include <gtest/gtest.h>

using namespace stylet::igtl;
using std::chrono::seconds;

namespace {

/// The counts that are told of within an hour, second by second, while a message a second is dropped.
std::vector<std::int64_t> told_in_an_hour(bool is_told_once) {
  DropLog log;
  std::vector<std::int64_t> counts;
  for (int second = 0; second < 3600; ++second) {
    log.add("checksum", "its checksum is 0", "Compute it", is_told_once);
    for (const Dropped& dropped : log.news(DropLog::Clock::time_point{} + seconds(second)))
      counts.push_back(dropped.count);
  }
  EXPECT_EQ(log.total(), 3600);
  return counts;
}

}  // namespace

TEST(DropLog, tells_of_the_first_at_once_and_of_more_after_pauses_that_double) {
  EXPECT_EQ(told_in_an_hour(false), (std::vector<std::int64_t>{1, 11, 31, 71, 151, 311, 631, 1271, 1911, 2551, 3191}));
  EXPECT_EQ(told_in_an_hour(true), (std::vector<std::int64_t>{1}));
}

TEST(DropLog, tells_nothing_twice_and_keeps_kinds_apart) {
  DropLog log;
  const DropLog::Clock::time_point now{};
  EXPECT_TRUE(log.news(now).empty());
  log.add("one", "first of one", "cure");
  log.add("one", "second of one", "another cure");
  log.add("two", "first of two", "cure");
  const std::vector<Dropped> news = log.news(now);
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].what, "second of one");
  EXPECT_EQ(news[0].cure, "another cure");
  EXPECT_EQ(news[0].count, 2);
  EXPECT_EQ(news[1].count, 1);
  EXPECT_TRUE(log.news(now + seconds(1000)).empty());
}

TEST(DropLog, any_number_of_kinds_takes_little_memory_and_few_lines) {
  DropLog log;
  std::size_t lines = 0;
  for (int k = 0; k < 1000; ++k) {
    log.add("kind " + std::to_string(k), "what", "cure", true);
    lines += log.news(DropLog::Clock::time_point{}).size();
  }
  EXPECT_EQ(log.total(), 1000);
  EXPECT_EQ(lines, DropLog::kMostKinds + 1);
}
