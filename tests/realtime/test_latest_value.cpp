// SPDX-License-Identifier: GPL-3.0-or-later
#include "realtime/event_queue.hpp"
#include "stylet/realtime/latest_value.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>

using namespace stylet;

namespace {

/// A value large enough to be seen half-written if the exchange were not atomic.
struct Block {
  std::array<std::int64_t, 200> number{};
};

constexpr std::int64_t kWrites = 200'000;

}  // namespace

TEST(LatestValue, is_new_once_and_then_stays) {
  LatestValue<int> value(7);
  EXPECT_FALSE(value.fetch());
  EXPECT_EQ(value.value(), 7);
  value.write(8);
  EXPECT_EQ(value.value(), 7) << "until fetched";
  EXPECT_TRUE(value.fetch());
  EXPECT_EQ(value.value(), 8);
  EXPECT_FALSE(value.fetch());
  EXPECT_EQ(value.value(), 8);
}

TEST(LatestValue, of_several_writes_the_reader_gets_the_newest) {
  LatestValue<int> value(0);
  for (int k = 1; k <= 10; ++k) {
    for (int w = 0; w < k; ++w) value.write(100 * k + w);
    ASSERT_TRUE(value.fetch());
    EXPECT_EQ(value.value(), 100 * k + k - 1);
  }
}

TEST(LatestValue, a_reader_never_sees_half_a_value_nor_an_older_one_while_it_is_written) {
  LatestValue<Block> value;
  std::thread writer([&] {
    for (std::int64_t k = 1; k <= kWrites; ++k) {
      value.draft().number.fill(k);
      value.publish();
    }
  });
  std::int64_t last = 0;
  std::int64_t fetched = 0;
  std::int64_t wrong = 0;
  while (last < kWrites) {
    if (!value.fetch()) continue;
    ++fetched;
    const Block& b = value.value();
    if (b.number.front() <= last) ++wrong;
    last = b.number.front();
    for (const std::int64_t n : b.number) wrong += n == last ? 0 : 1;
  }
  writer.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(fetched, 0);
  EXPECT_FALSE(value.fetch());
}

TEST(EventQueue, a_full_queue_keeps_the_oldest_and_counts_the_rest) {
  EventQueue<int, 8> queue;
  for (int k = 0; k < 11; ++k) EXPECT_EQ(queue.push(k), k < 8) << k;
  EXPECT_EQ(queue.dropped(), 3);
  std::array<int, 20> out{};
  ASSERT_EQ(queue.pop(out), 8u);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(out[static_cast<std::size_t>(k)], k);
  EXPECT_EQ(queue.pop(out), 0u);
  EXPECT_TRUE(queue.push(12));
}

TEST(EventQueue, what_one_thread_puts_in_comes_out_in_the_other_once_and_in_order) {
  EventQueue<std::int64_t, 1024> queue;
  std::int64_t refused = 0;
  std::thread writer([&] {
    for (std::int64_t k = 0; k < kWrites; ++k) {
      while (!queue.push(k)) {
        ++refused;
        std::this_thread::yield();
      }
    }
  });
  std::int64_t next = 0;
  std::int64_t wrong = 0;
  std::array<std::int64_t, 16> out{};
  while (next < kWrites) {
    const std::size_t count = queue.pop(out);
    if (count == 0) std::this_thread::yield();
    for (std::size_t k = 0; k < count; ++k) wrong += out[k] == next++ ? 0 : 1;
  }
  writer.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(queue.dropped(), refused);
  EXPECT_EQ(queue.pop(out), 0u);
}
