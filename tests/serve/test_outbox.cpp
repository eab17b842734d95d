// SPDX-License-Identifier: GPL-3.0-or-later
// The messages that wait for a connection.
#include "outbox.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

using namespace stylet::serve;

namespace {

std::uint32_t word(const wire::Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + 4 * at, sizeof value);
  return value;
}

wire::Kind kind_of(const std::optional<wire::Bytes>& bytes) {
  return bytes ? static_cast<wire::Kind>(word(*bytes, 0)) : wire::Kind{};
}

double time_of(const wire::Bytes& frame) {
  double value = 0.0;
  std::memcpy(&value, frame.data() + 8, sizeof value);
  return value;
}

/// A picture of so many bytes and a little more.
std::shared_ptr<const LiveFrame> picture(double time_s, std::size_t bytes) {
  auto frame = std::make_shared<LiveFrame>();
  frame->time_s = time_s;
  frame->displacement.resize(bytes / 2);
  return frame;
}

Parcel image(std::size_t bytes) {
  return as_parcel(std::make_shared<const LiveImage>(LiveImage{.text = "{}",
                                                               .rows = 1,
                                                               .columns = static_cast<std::uint32_t>(bytes),
                                                               .pixels = std::vector<std::uint8_t>(bytes)}));
}

}  // namespace

TEST(Outbox, numbers_messages_and_sends_states_after_what_waits_and_pictures_last) {
  Outbox box;
  auto frame = std::make_shared<LiveFrame>();
  box.put(std::shared_ptr<const LiveFrame>(frame), 0.0);
  box.put(std::shared_ptr<const LiveFrame>(frame), 0.0);
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
  box.put(std::make_shared<const LiveFrame>(), 0.0);
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

TEST(Outbox, sends_no_more_pictures_than_the_page_takes_up_and_then_the_newest) {
  Outbox box;
  std::size_t under_way = 0;
  for (int k = 0; k < 100; ++k) {
    box.put(picture(0.01 * k, 6000), 0.01 * k);
    while (const auto bytes = box.next()) under_way += bytes->size();
  }
  EXPECT_GE(under_way, Outbox::kMostUnseen);
  EXPECT_LE(under_way, Outbox::kMostUnseen + 7000) << "one picture more than the bound";
  EXPECT_FALSE(box.lag_s());
  box.seen({0}, 0.25);
  EXPECT_NEAR(*box.lag_s(), 0.25, 1e-12) << "the first picture was put in at 0 s";
  const auto next = box.next();
  ASSERT_EQ(kind_of(next), wire::Kind::frame);
  EXPECT_NEAR(time_of(*next), 0.99, 1e-12);
  EXPECT_FALSE(box.next());
}

TEST(Outbox, passes_on_events_and_states_while_no_picture_may_go) {
  Outbox box;
  box.put(picture(0.0, 20000), 0.0);
  EXPECT_EQ(kind_of(box.next()), wire::Kind::frame);
  box.put(picture(1.0, 20000), 1.0);
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(box.put(as_parcel(LiveEvent{"puncture", 1.0 * k, 0.0, 0.0, {}})));
  EXPECT_TRUE(box.put(parcel_of(SessionStatus{}, OwnStatus{})));
  EXPECT_TRUE(box.put(image(100)));
  for (const auto kind : {wire::Kind::event, wire::Kind::event, wire::Kind::event, wire::Kind::status})
    EXPECT_EQ(kind_of(box.next()), kind);
  EXPECT_FALSE(box.next());
  box.seen({77}, 2.0);  // no message has this number
  EXPECT_FALSE(box.next());
  box.seen({4}, 2.0);
  EXPECT_EQ(kind_of(box.next()), wire::Kind::image);
  EXPECT_EQ(kind_of(box.next()), wire::Kind::frame);
}

TEST(Outbox, of_pictures_of_two_kinds_neither_keeps_the_other_waiting) {
  Outbox box;
  int frames = 0;
  int images = 0;
  for (std::uint32_t k = 0; k < 100; ++k) {
    EXPECT_TRUE(box.put(image(50000)));
    box.put(picture(0.0, 20000), 0.0);
    const auto bytes = box.next();
    ++(kind_of(bytes) == wire::Kind::frame ? frames : images);
    EXPECT_FALSE(box.next());
    box.seen({k}, 0.0);
  }
  EXPECT_EQ(frames, 50);
  EXPECT_EQ(images, 50);
}

TEST(Outbox, a_picture_that_was_replaced_leaves_its_displacement_to_the_next) {
  Outbox box;
  box.put(picture(1.0, 600), 0.0);
  box.put(picture(2.0, 0), 0.0);
  const auto bytes = box.next();
  ASSERT_TRUE(bytes);
  EXPECT_EQ(time_of(*bytes), 2.0);
  EXPECT_EQ(word(*bytes, 40), 100u) << "nodes with a displacement";
}

TEST(Outbox, a_curve_that_has_waited_has_as_many_samples_as_it_is_worth) {
  Outbox box;
  const auto samples_after = [&box](int steps) {
    auto frame = std::make_shared<LiveFrame>();
    for (int k = 0; k < steps; ++k) {
      frame->curve.emplace_back();
      frame->curve.back().time_s = 1e-3 * k;
      frame->curve.back().force_axial_N = k == steps / 2 ? 5.0 : 0.0;
    }
    box.put(std::shared_ptr<const LiveFrame>(std::move(frame)), 0.0);
    const auto bytes = box.next();
    std::size_t highest = 0;
    for (std::size_t k = 0; k < word(*bytes, 39); ++k) {
      float force = 0.0F;
      std::memcpy(&force, bytes->data() + 168 + 32 * k + 8, sizeof force);
      highest += force == 5.0F ? 1 : 0;
    }
    EXPECT_EQ(highest, 1u) << "the extreme is kept";
    return word(*bytes, 39);
  };
  EXPECT_EQ(samples_after(17), 17u);
  EXPECT_LE(samples_after(300), 64u);
  EXPECT_LE(samples_after(2000), 240u);
  EXPECT_GE(samples_after(2000), 120u);
}

TEST(Outbox, sends_smaller_pictures_to_a_page_that_gets_them_late) {
  Outbox box;
  auto size_after = [&, k = 0U](double lag_s) mutable {
    box.put(picture(0.0, 6000), 0.0);
    const std::size_t size = box.next()->size();
    box.seen({k++}, lag_s);
    return size;
  };
  const std::size_t whole = size_after(0.05);
  EXPECT_EQ(size_after(0.3), whole);
  EXPECT_EQ(size_after(0.05), whole - 3000);
  EXPECT_EQ(size_after(0.05), whole);
}
