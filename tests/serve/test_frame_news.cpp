// SPDX-License-Identifier: GPL-3.0-or-later
// Which pictures of a needle are passed on.
#include "frame_news.hpp"

#include <gtest/gtest.h>

using namespace stylet::serve;
using News = FrameNews::Verdict;

namespace {

/// Pictures 60 times a second.
struct Stream {
  FrameNews news;
  LiveFrame frame;
  double now_s = 0.0;

  News next(bool is_news = false) {
    now_s += 1.0 / 60.0;
    frame.time_s = now_s;
    ++frame.steps;
    return news.judge(frame, is_news, now_s);
  }
  /// Passes on what is new until there is nothing more.
  void settle() {
    while (next() != News::nothing) {
    }
  }
};

}  // namespace

TEST(FrameNews, a_needle_at_rest_gives_a_sign_of_life_a_few_times_a_second) {
  Stream stream;
  EXPECT_EQ(stream.next(), News::news) << "the first";
  stream.settle();
  int signs = 0;
  for (int k = 0; k < 600; ++k) {
    const News verdict = stream.next();
    EXPECT_NE(verdict, News::news);
    signs += verdict == News::sign_of_life ? 1 : 0;
  }
  EXPECT_GE(signs, 50) << "in ten seconds";
  EXPECT_LE(signs, 70);
}

TEST(FrameNews, what_can_be_seen_is_news_and_what_cannot_only_when_it_adds_up) {
  Stream stream;
  stream.frame.centreline = {1, 2, 3};
  stream.frame.contacts.resize(1);
  stream.settle();
  const auto is_news = [&](auto change) {
    change(stream.frame);
    const bool passed = stream.next() == News::news;
    stream.settle();
    return passed;
  };
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.step.base_depth_mm += 0.02; }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.step.force_lateral_N -= 0.01; }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.roll_deg += 0.1; }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.centreline[2] += 0.02F; }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.contacts[0].force[1] += 0.01; }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.contacts.clear(); }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.bits |= LiveFrame::trusted; }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.tip_error = stylet::TipError{stylet::Vec3::Zero(), 3.0}; }));
  EXPECT_TRUE(is_news([](LiveFrame& f) { f.bits &= ~std::uint32_t{LiveFrame::trusted}; }));
  int steps = 0;
  while (!is_news([](LiveFrame& f) { f.step.base_depth_mm += 0.0021; })) ++steps;
  EXPECT_EQ(steps, 4) << "the fifth of these steps makes a hundredth of a millimetre";
}

TEST(FrameNews, a_single_step_of_a_paused_needle_is_news) {
  Stream stream;
  stream.frame.bits = LiveFrame::paused;
  EXPECT_EQ(stream.next(), News::news);
  EXPECT_EQ(stream.next(), News::news);
}

TEST(FrameNews, two_more_pictures_follow_so_that_a_page_sees_the_needle_stand) {
  Stream stream;
  stream.settle();
  EXPECT_EQ(stream.next(true), News::news);
  EXPECT_EQ(stream.next(), News::news);
  EXPECT_EQ(stream.next(), News::news);
  EXPECT_EQ(stream.next(), News::nothing);
}
