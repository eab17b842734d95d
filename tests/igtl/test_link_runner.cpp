// SPDX-License-Identifier: GPL-3.0-or-later
// A running loop whose hand is tracked at the other end of a link.
#include "peer.hpp"

#include <mutex>

using namespace stylet;
using namespace stylet::igtl;
using namespace stylet::test;

namespace {

/// A spring whose base is moved by a TRANSFORM and whose state is sent through the same link.
struct LinkedRun {
  std::unique_ptr<Link> link = opened(any_port());
  std::unique_ptr<RealtimeRunner> runner;
  std::unique_ptr<Repeat> display;
  std::mutex mutex;   ///< guards the reading side of the runner
  Snapshot snapshot;  ///< the newest snapshot, guarded by the mutex
  DeviceSnapshot at_device;

  explicit LinkedRun(double late_after_s = 0.5) {
    RunnerSettings s = plain_settings();
    s.late_after_s = late_after_s;
    auto made = RealtimeRunner::create(std::make_unique<SpringBody>(), link->device(), s);
    if (!made) throw std::runtime_error(made.error().message());
    runner = std::move(*made);
    if (!runner->start().ok()) throw std::runtime_error("no threads");
    display = std::make_unique<Repeat>([this] {
      runner->fetch_snapshot();
      runner->fetch_device();
      link->publish(picture_of(runner->snapshot(), runner->device_snapshot()));
      const std::scoped_lock lock(mutex);
      snapshot = runner->snapshot();
      at_device = runner->device_snapshot();
    });
  }
  ~LinkedRun() {
    display.reset();
    runner->stop();
  }

  [[nodiscard]] double felt() {
    const std::scoped_lock lock(mutex);
    return at_device.sent.force[2];
  }
  [[nodiscard]] Triple base() {
    const std::scoped_lock lock(mutex);
    return plain(snapshot.step.base.origin);
  }
  [[nodiscard]] int port() const { return link->state().port; }
};

bool no_force(const Peer::Message& m) { return wrench_of(m) == std::array<double, 6>{}; }
bool newtons(const Peer::Message& m, double fz) { return std::abs(wrench_of(m)[2] - fz) < 1e-9; }

/// Sends the handle's position repeatedly until it is destroyed.
struct Hand {
  Repeat repeat;
  Hand(Peer& peer, const std::array<float, 12>& m)
      : repeat([&peer, m] { peer.send(library_transform("HandleToReference", m)); }) {}
};

}  // namespace

TEST(LinkedRunner, a_pose_goes_in_moves_the_base_and_comes_out_again) {
  LinkedRun run;
  Peer peer = Peer::to(run.port());
  // A rotation by a third of a turn (RAS) moves every axis to another axis.
  const std::array<float, 12> where{0, -1, 0, 0, 0, 1, -1, 0, 0, -3, 5, 4};
  const Hand hand(peer, where);
  ASSERT_TRUE(comes_true([&] { return run.base() == Triple{3, -5, 4}; })) << "LPS";
  const auto back = peer.next("TRANSFORM", "NeedleBaseToReferenc", [&](const auto& m) {
    const auto got = matrix_of(m);
    for (std::size_t k = 0; k < got.size(); ++k)
      if (std::abs(got[k] - where[k]) > 1e-5) return false;
    return true;
  });
  EXPECT_TRUE(back);
  EXPECT_TRUE(peer.next("NDARRAY", "BaseForce", [](const auto& m) { return newtons(m, -4.0); }));
}

TEST(LinkedRunner, a_hand_that_disconnects_feels_nothing_and_comes_back) {
  LinkedRun run;
  Peer display = Peer::to(run.port());
  for (int round = 0; round < 2; ++round) {
    const float z = 3.0F + static_cast<float>(round);
    Peer tracker = Peer::to(run.port());
    {
      const Hand hand(tracker, at(0, 0, z));
      ASSERT_TRUE(display.next("NDARRAY", "BaseForce", [&](const auto& m) { return newtons(m, -z); })) << round;
    }
    tracker.close();
    ASSERT_TRUE(comes_true([&] { return run.felt() == 0.0; })) << round;
    ASSERT_TRUE(display.next("NDARRAY", "BaseForce", no_force)) << round;
    EXPECT_TRUE(comes_true([&] { return !run.link->state().tracked; }));
    EXPECT_EQ(run.base(), (Triple{0, 0, z})) << "the base stays";
  }
}

TEST(LinkedRunner, a_hand_that_falls_silent_feels_nothing_though_it_is_connected) {
  LinkedRun run(0.1);
  Peer peer = Peer::to(run.port());
  const auto press = [&](float z) {
    const Hand hand(peer, at(0, 0, z));
    return peer.next("NDARRAY", "BaseForce", [&](const auto& m) { return newtons(m, -z); }).has_value();
  };
  ASSERT_TRUE(press(3.0F));
  ASSERT_TRUE(comes_true([&] { return run.felt() == 0.0; }));
  ASSERT_TRUE(peer.next("NDARRAY", "BaseForce", no_force));
  EXPECT_EQ(run.link->state().connections, 1);
  ASSERT_TRUE(press(4.0F)) << "and it comes back";
}

TEST(LinkedRunner, a_sender_that_says_it_is_not_ready_or_sends_no_pose_is_not_followed) {
  LinkedRun run;
  Peer peer = Peer::to(run.port());
  {
    const Hand hand(peer, at(0, 0, 3));
    ASSERT_TRUE(peer.next("NDARRAY", "BaseForce", [](const auto& m) { return newtons(m, -3.0); }));
  }
  const std::array<float, 12> mirrored{1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 9};
  {
    const Hand hand(peer, mirrored);
    ASSERT_TRUE(peer.next("NDARRAY", "BaseForce", no_force));
  }
  {
    const Hand hand(peer, at(0, 0, 3));
    ASSERT_TRUE(peer.next("NDARRAY", "BaseForce", [](const auto& m) { return newtons(m, -3.0); }));
  }
  peer.send(library_status("Tracker", ::igtl::StatusMessage::STATUS_NOT_PRESENT));
  {
    const Hand hand(peer, at(0, 0, 9));
    ASSERT_TRUE(peer.next("NDARRAY", "BaseForce", no_force));
    EXPECT_EQ(run.base(), (Triple{0, 0, 3}));
  }
  peer.send(library_status("Tracker", ::igtl::StatusMessage::STATUS_OK));
  const Hand hand(peer, at(0, 0, 2));
  ASSERT_TRUE(peer.next("NDARRAY", "BaseForce", [](const auto& m) { return newtons(m, -2.0); }));
}

TEST(LinkedRunner, the_device_outlives_its_link_without_a_hand) {
  auto link = opened(any_port());
  RunnerSettings s = plain_settings();
  s.late_after_s = 0.5;
  auto made = RealtimeRunner::create(std::make_unique<SpringBody>(), link->device(), s);
  ASSERT_TRUE(made);
  auto& runner = **made;
  ASSERT_TRUE(runner.start().ok());
  const auto felt = [&] {
    runner.fetch_device();
    return runner.device_snapshot().sent.force[2];
  };
  Peer peer = Peer::to(link->state().port);
  const Hand hand(peer, at(0, 0, 3));
  EXPECT_TRUE(comes_true([&] { return std::abs(felt() + 3.0) < 1e-9; }));
  link.reset();
  EXPECT_TRUE(comes_true([&] { return felt() == 0.0 && !runner.device_snapshot().input.valid; }));
  runner.stop();
}

TEST(LinkedRunner, the_last_device_asked_for_is_the_one_that_is_fed) {
  const auto link = opened(any_port());
  const auto first = link->device();
  const auto second = link->device();
  double now_s = 0.0;
  Peer peer = Peer::to(link->state().port);
  const Hand hand(peer, at(0, 0, 3));
  EXPECT_TRUE(comes_true([&] { return second->read({.now_s = now_s += 0.001}).valid; }));
  EXPECT_FALSE(first->read({.now_s = 1.0}).valid);
  EXPECT_FALSE(first->read({.now_s = 2.0}).valid);
}

TEST(LinkedRunner, neither_thread_of_the_loop_allocates_with_a_link) {
  if (!AllocationCount::available()) GTEST_SKIP() << "not with a sanitizer";
  const auto link = opened(any_port());
  RunnerSettings s = plain_settings();
  s.late_after_s = 0.5;
  auto device = std::make_unique<CountingDevice>(link->device());
  CountingDevice& counted = *device;
  auto made = RealtimeRunner::create(std::make_unique<SpringBody>(), std::move(device), s);
  ASSERT_TRUE(made);
  ASSERT_TRUE((*made)->start().ok());
  Peer peer = Peer::to(link->state().port);
  const Hand hand(peer, at(0, 0, 3));
  EXPECT_TRUE(comes_true([&] {
    (*made)->fetch_device();
    return std::abs((*made)->device_snapshot().sent.force[2] + 3.0) < 1e-9;
  }));
  (*made)->stop();
  EXPECT_EQ(counted.allocations.load(), 0);
}
