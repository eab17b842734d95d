// SPDX-License-Identifier: GPL-3.0-or-later
// When the displacement field is made.
#include "field_maker.hpp"
#include "serving.hpp"

#include <chrono>
#include <thread>

using namespace stylet;
using namespace stylet::serve;
using namespace stylet::test;

namespace {

constexpr std::chrono::hours kNever(1000);

/// Waits until the maker has ended. @return false if it does not end
bool ends(const FieldMaker& maker) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!maker.done() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return maker.done();
}

}  // namespace

TEST(FieldMaker, makes_the_field_when_it_is_told_to_begin) {
  FieldMaker maker(compiled(hole_scenario()), kNever);
  maker.begin();
  ASSERT_TRUE(ends(maker));
  EXPECT_TRUE(maker.field());
}

TEST(FieldMaker, begins_by_itself_when_nobody_tells_it_to) {
  const FieldMaker maker(compiled(hole_scenario()), std::chrono::milliseconds(20));
  ASSERT_TRUE(ends(maker));
  EXPECT_TRUE(maker.field());
}

TEST(FieldMaker, gives_up_while_it_waits) {
  FieldMaker maker(compiled(hole_scenario()), kNever);
  const FieldMaker other(compiled(hole_scenario()), std::chrono::seconds(0));
  ASSERT_TRUE(ends(other));  // in this time it would have made a part of its field
  EXPECT_FALSE(maker.done());
  EXPECT_EQ(maker.fraction(), 0.0);
  maker.give_up();
  ASSERT_TRUE(ends(maker));
  EXPECT_FALSE(maker.field());
}

TEST(FieldMaker, of_a_server_begins_when_a_page_has_drawn_whoever_holds_the_needle) {
  const Serving serving([](ServerSettings& s) { s.session.field_waits_s = 1e6; });
  const auto holder = ready_client(serving);
  ASSERT_TRUE(holder->take());
  EXPECT_NE(holder->status["stage"], "") << "still missing";
  const auto watcher = ready_client(serving);
  watcher->command(R"({"do":"drawn"})");
  EXPECT_TRUE(holder->until([&] { return holder->displaced_nodes > 0; }));
  EXPECT_TRUE(watcher->notices.empty());
  // Once a page has drawn, the field of another case is prepared without waiting.
  holder->command(R"({"do":"case","index":1})");
  EXPECT_TRUE(holder->until([&] { return holder->scene["case"] == 1 && holder->status["stage"] == ""; }));
}
