// SPDX-License-Identifier: GPL-3.0-or-later
// The messages that wait for a connection.
#include "outbox.hpp"

#include <gtest/gtest.h>

#include <cstring>

using namespace stylet::serve;

namespace {

std::uint32_t word(const wire::Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + 4 * at, sizeof value);
  return value;
}

}  // namespace

TEST(Outbox, numbers_messages_and_sends_states_after_what_waits_and_pictures_last) {
  Outbox box;
  auto frame = std::make_shared<LiveFrame>();
  box.put(std::shared_ptr<const LiveFrame>(frame));
  box.put(std::shared_ptr<const LiveFrame>(frame));
  EXPECT_TRUE(box.put(parcel_of(SessionStatus{}, OwnStatus{})));
  EXPECT_TRUE(box.put(parcel_of(Notice{"no", "yes"})));
  for (const auto kind : {wire::Kind::notice, wire::Kind::status, wire::Kind::frame}) {
    const auto bytes = box.next();
    ASSERT_TRUE(bytes);
    EXPECT_EQ(word(*bytes, 0), static_cast<std::uint32_t>(kind));
  }
  EXPECT_FALSE(box.next());
  EXPECT_EQ(box.skipped_frames(), 1);
  EXPECT_TRUE(box.put(parcel_of(Notice{"no", "yes"})));
  EXPECT_EQ(word(*box.next(), 1), 3u) << "the fourth message";
}

TEST(Outbox, keeps_the_newest_map_all_events_and_no_picture_of_a_former_scene) {
  Outbox box;
  box.put(std::make_shared<const LiveFrame>());
  for (int k = 0; k < 2; ++k) {
    EXPECT_TRUE(box.put(as_parcel(LiveMap{.predicted = k})));
    EXPECT_TRUE(box.put(as_parcel(LiveEvent{"puncture", 0.0, 0.0, 0.0, {}})));
  }
  EXPECT_TRUE(box.put(as_parcel(std::make_shared<const Scene>())));
  int messages = 0;
  while (box.next()) ++messages;
  EXPECT_EQ(messages, 4) << "two events, a map and a scene";
}

TEST(Outbox, of_a_page_that_does_not_read_is_full_one_day) {
  Outbox box;
  const Parcel notice = parcel_of(Notice{});
  int taken = 0;
  while (taken < 10000 && box.put(notice)) ++taken;
  EXPECT_EQ(taken, 2000);
}
