// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl/pose_input.hpp"

#include "library_messages.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::igtl;
using std::chrono::milliseconds;
using stylet::test::at;
using Heard = PoseInput::Heard;

namespace {

struct Handle {
  PoseInput input{"Handle"};
  std::shared_ptr<PoseChannel> channel = std::make_shared<PoseChannel>();
  PoseInput::Clock::time_point now{};

  Handle() { input.feed(channel); }
  PoseInput::Heard pose(ConnectionId from, const RasMatrix& m) { return input.hear_pose(from, m, now); }
  void status(ConnectionId from, std::uint16_t code, const std::string& name = "Tracker") {
    input.hear_status(from, name, code);
  }
  /// x (LPS) of the pose that the loop would read; empty if the pose is not valid.
  std::optional<double> x() {
    channel->fetch();
    const TrackedPose& p = channel->value();
    EXPECT_EQ(p.valid, input.tracked());
    if (!p.valid) return {};
    return p.pose.origin[0];
  }
};

}  // namespace

TEST(PoseInput, takes_a_pose_as_lps) {
  Handle h;
  EXPECT_FALSE(h.x());
  EXPECT_EQ(h.pose(1, at(-3, -4, 5)), Heard::used);
  EXPECT_EQ(h.x(), 3.0);
  EXPECT_EQ(h.channel->value().pose.origin, (Triple{3, 4, 5}));
  EXPECT_EQ(h.input.counts().poses, 1);
}

TEST(PoseInput, a_matrix_that_is_no_rigid_motion_loses_the_handle_until_the_next_good_one) {
  Handle h;
  h.pose(1, at(-3, 0, 0));
  EXPECT_EQ(h.pose(1, RasMatrix{}), Heard::no_rigid_motion);
  EXPECT_FALSE(h.x());
  EXPECT_EQ(h.input.counts().unusable, 1);
  h.pose(1, at(-4, 0, 0));
  EXPECT_EQ(h.x(), 4.0);
}

TEST(PoseInput, a_status_that_is_not_ok_loses_it_until_the_same_name_is_ok) {
  Handle h;
  h.pose(1, at(-3, 0, 0));
  h.status(1, 13, "Tracker");
  EXPECT_FALSE(h.x());
  EXPECT_EQ(h.pose(1, at(-4, 0, 0)), Heard::sender_not_ok);
  EXPECT_FALSE(h.x()) << "poses go on all the same";
  h.status(1, 1, "Robot");
  h.pose(1, at(-4, 0, 0));
  EXPECT_FALSE(h.x()) << "the robot is fine, the tracker is not";
  h.status(1, 1, "Tracker");
  h.pose(1, at(-5, 0, 0));
  EXPECT_EQ(h.x(), 5.0);
}

TEST(PoseInput, the_status_of_another_connection_does_not_matter) {
  Handle h;
  h.pose(1, at(-3, 0, 0));
  h.status(2, 13);
  EXPECT_EQ(h.x(), 3.0);
}

TEST(PoseInput, any_number_of_complaints_takes_little_memory_and_stays_a_complaint) {
  Handle h;
  h.pose(1, at(-3, 0, 0));
  for (int k = 0; k < 1000; ++k) h.status(1, 2, std::to_string(k));
  EXPECT_FALSE(h.x());
  for (std::size_t k = 0; k < PoseInput::kComplaints; ++k) h.status(1, 1, std::to_string(k));
  h.pose(1, at(-4, 0, 0));
  EXPECT_EQ(h.x(), 4.0);
}

TEST(PoseInput, one_connection_at_a_time_has_the_handle) {
  Handle h;
  h.pose(1, at(-3, 0, 0));
  EXPECT_EQ(h.pose(2, at(-9, 0, 0)), Heard::of_other);
  EXPECT_EQ(h.x(), 3.0);
  EXPECT_EQ(h.input.counts().of_others, 1);
  h.now += milliseconds(900);
  h.pose(1, at(-4, 0, 0));
  h.now += milliseconds(900);
  h.pose(2, at(-9, 0, 0));
  EXPECT_EQ(h.x(), 4.0);
  h.now += milliseconds(101);
  h.pose(2, at(-9, 0, 0));
  EXPECT_EQ(h.x(), 9.0) << "the first has been silent for a second";
  h.pose(1, at(-4, 0, 0));
  EXPECT_EQ(h.x(), 9.0);
}

TEST(PoseInput, a_connection_that_closes_loses_the_handle_at_once_to_whoever_is_next) {
  Handle h;
  h.pose(1, at(-3, 0, 0));
  h.status(1, 13);
  h.pose(1, at(-3, 0, 0));
  h.input.closed(2);
  h.input.closed(1);
  EXPECT_FALSE(h.x());
  h.pose(2, at(-9, 0, 0));
  EXPECT_EQ(h.x(), 9.0);
  h.input.closed(2);
  h.pose(1, at(-4, 0, 0));
  EXPECT_EQ(h.x(), 4.0) << "a new connection, without the complaint of the old one";
}

TEST(PoseInput, a_new_channel_hears_nothing_of_before) {
  Handle h;
  h.pose(1, at(-3, 0, 0));
  const auto second = std::make_shared<PoseChannel>();
  h.input.feed(second);
  EXPECT_FALSE(second->fetch());
  h.pose(1, at(-4, 0, 0));
  EXPECT_TRUE(second->fetch());
  EXPECT_TRUE(second->value().valid);
}
