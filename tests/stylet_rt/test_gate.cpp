// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/box_patient.hpp"
#include "stylet_rt/boundary.hpp"
#include "stylet_rt/handles.hpp"

#include <array>
#include <thread>

using namespace stylet;
using namespace stylet::rt;

TEST(Gate, lets_in_any_number_of_readers_or_one_that_changes) {
  Gate gate;
  EXPECT_TRUE(gate.enter());
  EXPECT_TRUE(gate.enter());
  EXPECT_FALSE(gate.close());
  gate.leave();
  EXPECT_FALSE(gate.close());
  gate.leave();
  EXPECT_TRUE(gate.close());
  EXPECT_FALSE(gate.close());
  EXPECT_FALSE(gate.enter());
  gate.open();
  EXPECT_TRUE(gate.enter());
}

TEST(Gate, keeps_readers_of_several_threads_from_what_changes) {
  Gate gate;
  std::array<int, 2> shared{};  // both alike, except behind the closed gate
  std::atomic<bool> over{false};
  std::atomic<int> torn{0};
  std::vector<std::thread> readers;
  for (int r = 0; r < 2; ++r) {
    readers.emplace_back([&] {
      while (!over) {
        const Reading reading(gate);
        if (reading && shared[0] != shared[1]) ++torn;
      }
    });
  }
  int changes = 0;
  while (changes < 1000) {
    const Changing changing(gate);
    if (!changing) {
      std::this_thread::yield();
      continue;
    }
    ++shared[0];
    ++shared[1];
    ++changes;
  }
  over = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(shared[0], 1000);
}

TEST(ErrorText, is_cut_between_characters_and_ends_in_a_zero) {
  std::array<char, 8> text{};
  text.fill('x');
  ErrorText error(text.data(), 6);
  EXPECT_STREQ(text.data(), "");
  error.say("1 → 2");
  EXPECT_STREQ(text.data(), "1 →");
  error.say("1  → 2");
  EXPECT_STREQ(text.data(), "1  ");
  EXPECT_EQ(text[6], 'x');
  ErrorText nowhere(nullptr, 0);
  nowhere.say("unheard");
}

TEST(Boundary, lets_no_exception_out) {
  std::array<char, 64> text{};
  ErrorText error(text.data(), text.size());
  EXPECT_EQ(guarded(error, []() -> stylet_rt_status { throw std::bad_alloc(); }), STYLET_RT_OUT_OF_MEMORY);
  EXPECT_STREQ(text.data(), "out of memory");
  EXPECT_EQ(guarded(error, []() -> stylet_rt_status { throw std::runtime_error("what it was"); }), STYLET_RT_FAILED);
  EXPECT_STREQ(text.data(), "what it was");
  EXPECT_EQ(guarded(error, []() -> stylet_rt_status { throw 1; }), STYLET_RT_FAILED);
}
