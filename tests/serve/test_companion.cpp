// SPDX-License-Identifier: GPL-3.0-or-later
// A session with a companion, another program that is shown the simulation or moves the needle.
#include "serving.hpp"

#include "stylet/realtime/latest_value.hpp"

#include <mutex>
#include <utility>

using namespace stylet;
using namespace stylet::test;

namespace {

using Matrix = Eigen::Matrix3Xf;

/// The position of the hand. Like an OpenIGTLink connection, it passes poses to the loop without waiting.
using Channel = LatestValue<DeviceInput>;

struct HandDevice final : Device {
  std::shared_ptr<Channel> channel;
  explicit HandDevice(std::shared_ptr<Channel> from) : channel(std::move(from)) {}
  [[nodiscard]] DeviceTraits traits() const override { return {.name = "hand"}; }
  DeviceInput read(const DeviceTime& time) noexcept override {
    channel->fetch();
    DeviceInput input = channel->value();
    input.time_s = time.now_s;
    return input;
  }
  void write(const Wrench& /*on_hand*/) noexcept override {}
};

/// A companion that stores what it is shown.
class Friend final : public serve::Companion {
 public:
  explicit Friend(bool has_hand) : has_hand_(has_hand) {}

  [[nodiscard]] std::string name() const override { return "a friend"; }
  [[nodiscard]] std::unique_ptr<Device> device() override {
    const std::scoped_lock lock(mutex_);
    ++devices;
    if (!has_hand_) return nullptr;
    channel_ = std::make_shared<Channel>();
    return std::make_unique<HandDevice>(channel_);
  }
  [[nodiscard]] std::string why_no_pose() const override { return "it sleeps"; }
  void show(const serve::Scene& scene) override {
    const std::scoped_lock lock(mutex_);
    scenes.push_back(scene.positions.size() / 3);
  }
  void show(const Snapshot& snapshot, const DeviceSnapshot& device) override {
    const std::scoped_lock lock(mutex_);
    ++pictures;
    base = plain(snapshot.step.base);
    pushes_N = std::max(pushes_N, vec3(device.sent.force).norm());
  }
  void show(const Eigen::Ref<const Matrix>& displacement) override {
    const std::scoped_lock lock(mutex_);
    displaced_nodes = static_cast<std::size_t>(displacement.cols());
    most_mm = std::max(most_mm, static_cast<double>(displacement.cwiseAbs().maxCoeff()));
  }

  std::vector<serve::Notice> news() override {
    const std::scoped_lock lock(mutex_);
    return std::exchange(untold, {});
  }
  [[nodiscard]] std::int64_t not_used() const override { return 3; }
  std::vector<serve::GivenCommand> take_commands() override {
    const std::scoped_lock lock(mutex_);
    std::vector<serve::GivenCommand> commands;
    for (const std::string& text : std::exchange(given, {})) {
      commands.push_back({text, [this](const std::optional<serve::Notice>& refused) {
                            const std::scoped_lock answering(mutex_);
                            answers.push_back(refused ? refused->text : "done");
                          }});
    }
    return commands;
  }

  /// Sets the hand's pose; without a pose, the hand is not tracked.
  void hand(const std::optional<Pose>& where) {
    const std::scoped_lock lock(mutex_);
    DeviceInput input;
    input.valid = where.has_value();
    if (where) input.pose = plain(*where);
    channel_->write(input);
  }
  template <class Read>
  auto locked(Read read) {
    const std::scoped_lock lock(mutex_);
    return read(*this);
  }

  std::vector<std::size_t> scenes;
  int devices = 0;
  int pictures = 0;
  PlainPose base;
  double pushes_N = 0.0, most_mm = 0.0;
  std::size_t displaced_nodes = 0;
  std::vector<serve::Notice> untold;
  std::vector<std::string> given, answers;

 private:
  bool has_hand_;
  std::mutex mutex_;
  std::shared_ptr<Channel> channel_;
};

struct WithFriend {
  std::shared_ptr<Friend> companion;
  Serving serving;
  std::unique_ptr<LiveClient> client;
  explicit WithFriend(bool has_hand)
      : companion(std::make_shared<Friend>(has_hand)),
        serving([this](serve::ServerSettings& s) { s.session.companion = companion; }),
        client(ready_client(serving)) {
    EXPECT_TRUE(client->take());
  }
  [[nodiscard]] Pose base() const {
    return pose(companion->locked([](const Friend& f) { return f.base; }));
  }
  /// Gives a command. @return the answer
  std::string command(const std::string& text) {
    const auto answered = companion->locked([&](Friend& f) {
      f.given.push_back(text);
      return f.answers.size();
    });
    EXPECT_TRUE(
        client->until([&] { return companion->locked([&](Friend& f) { return f.answers.size() > answered; }); }));
    return companion->locked([](Friend& f) { return f.answers.back(); });
  }
  [[nodiscard]] std::string problem() const { return client->status.value("device_problem", "?"); }
  /// Moves the handle, one millimetre ahead of the base, until the base is this far from `start` along its axis.
  bool push(const Pose& start, double from_mm, double to_mm) {
    const Vec3 axis = start.rotation * Vec3::UnitZ();
    return client->until([&] {
      const double at_mm = std::min(to_mm, std::max(from_mm, (base().origin - start.origin).dot(axis)) + 1.0);
      companion->hand(Pose{start.origin + at_mm * axis, start.rotation});
      return (base().origin - start.origin - to_mm * axis).norm() < 1e-6;
    });
  }
};

}  // namespace

TEST(Companion, sees_what_the_pages_see_while_a_page_moves_the_needle) {
  WithFriend with(false);
  LiveClient& client = *with.client;
  EXPECT_EQ(client.status["device"], "page");
  client.hand(20.0F, 100.0F);
  ASSERT_TRUE(client.until([&] { return client.depth_mm > 19.9F && client.displaced_nodes > 0; }));
  Friend& seen = *with.companion;
  EXPECT_TRUE(client.until([&] { return seen.locked([](const Friend& f) { return f.most_mm > 0.01; }); }));
  EXPECT_EQ(client.status["device_problem"], "");
  seen.locked([&](const Friend& f) {
    EXPECT_EQ(f.scenes, std::vector<std::size_t>{client.scene_nodes});
    EXPECT_EQ(f.displaced_nodes, client.scene_nodes);
    EXPECT_GT(f.pushes_N, 0.1);
    EXPECT_EQ(f.devices, 1);
  });
}

TEST(Companion, with_the_hand_moves_the_needle_and_the_page_does_not) {
  WithFriend with(true);
  LiveClient& client = *with.client;
  EXPECT_EQ(client.status["device"], "a friend");
  ASSERT_TRUE(client.until([&] { return with.problem() == "it sleeps"; }));
  const Pose start = with.base();
  client.hand(20.0F, 100.0F);
  ASSERT_TRUE(client.passes(0.3));
  EXPECT_LT(client.depth_mm, 0.0F);

  with.companion->hand(Pose{start.origin + Vec3(50, 0, 0), start.rotation});
  ASSERT_TRUE(client.until([&] { return with.problem().find("50 mm and 0 degrees") != std::string::npos; }));
  ASSERT_TRUE(with.push(start, 0.0, 25.0));
  ASSERT_TRUE(client.until([&] { return with.problem().empty(); }));
  EXPECT_TRUE(client.has_event("skin_contact"));
  with.companion->hand(std::nullopt);
  ASSERT_TRUE(client.until([&] { return with.problem() == "it sleeps"; })) << "lost";
  const float there = client.depth_mm;
  ASSERT_TRUE(client.passes(0.3));
  EXPECT_EQ(client.depth_mm, there) << "the needle stays";
  ASSERT_TRUE(with.push(start, 25.0, 30.0)) << "and is taken up again";
}

TEST(Companion, keeps_the_hand_over_resets_and_holes) {
  WithFriend with(true);
  LiveClient& client = *with.client;
  const Pose start = with.base();
  ASSERT_TRUE(with.push(start, 0.0, 20.0));
  const std::string name = client.recording();
  client.command(R"({"do":"reset"})");
  ASSERT_TRUE(client.until([&] { return client.recording() != name && client.depth_mm < 0.0F; }));
  EXPECT_EQ(client.status["device"], "a friend");
  ASSERT_TRUE(with.push(start, 0.0, 15.0)) << "from its start";
  client.command(R"({"do":"hole","hole":"E3.5"})");
  ASSERT_TRUE(client.until([&] { return client.status.value("hole", "") == "E3.5" && client.ready(); }));
  with.companion->locked([](const Friend& f) {
    EXPECT_EQ(f.devices, 3);
    EXPECT_EQ(f.scenes.size(), 2u);
  });
}

TEST(Companion, sees_nothing_while_a_recording_is_replayed) {
  WithFriend with(false);
  LiveClient& client = *with.client;
  ASSERT_TRUE(client.go_to(5.0F, 100.0F));
  const std::string name = client.recording();
  client.command(R"({"do":"reset"})");
  ASSERT_TRUE(client.replay(name));
  const int pictures = with.companion->locked([](const Friend& f) { return f.pictures; });
  client.command(R"({"do":"play","rate":2})");
  ASSERT_TRUE(client.passes(0.05));
  EXPECT_EQ(with.companion->locked([](const Friend& f) { return f.pictures; }), pictures);
  client.command(R"({"do":"live"})");
  EXPECT_TRUE(
      client.until([&] { return with.companion->locked([](const Friend& f) { return f.pictures; }) > pictures; }));
}

TEST(Companion, with_the_hand_starts_again_and_chooses_a_hole) {
  WithFriend with(true);
  LiveClient& client = *with.client;
  const std::string first = client.recording();
  EXPECT_EQ(with.command("start again"), "done") << "also while a page holds the needle";
  ASSERT_TRUE(client.until([&] { return client.recording() != first; }));
  EXPECT_EQ(with.command("hole E3.5"), "done");
  ASSERT_TRUE(client.until([&] { return client.status.value("hole", "") == "E3.5"; }));
  EXPECT_NE(with.command("hole Z99").find("Z99"), std::string::npos) << "with the words that a page gets";
  EXPECT_EQ(with.command("take"), "'take': this command is for pages only");
  EXPECT_EQ(with.command("seek 1"), "no recording is shown now");
  ASSERT_TRUE(client.replay(first));
  EXPECT_EQ(with.command("reset"), "no needle is live now");
  ASSERT_TRUE(client.back_to_live());
  EXPECT_TRUE(client.until([&] { return client.status.value("hole", "") == "E3.5"; })) << "as it was";
}

TEST(Companion, without_the_hand_has_no_command_while_a_page_holds_the_needle) {
  WithFriend with(false);
  LiveClient& client = *with.client;
  const std::string first = client.recording();
  EXPECT_EQ(with.command("reset"), "a page holds the needle");
  EXPECT_EQ(client.recording(), first);
  client.command(R"({"do":"release"})");
  ASSERT_TRUE(client.until([&] { return !client.status.value("held", true); }));
  EXPECT_EQ(with.command("reset"), "done");
  EXPECT_TRUE(client.until([&] { return client.recording() != first; }));
}

TEST(Companion, tells_pages_and_terminal_what_it_does_not_use) {
  const auto companion = std::make_shared<Friend>(false);
  std::mutex mutex;
  std::vector<std::string> said;
  const Serving serving([&](serve::ServerSettings& s) {
    s.session.companion = companion;
    s.session.say = [&](const std::string& text) {
      const std::scoped_lock lock(mutex);
      said.push_back(text);
    };
  });
  const auto client = ready_client(serving);
  EXPECT_EQ(client->status["companion"]["name"], "a friend");
  companion->locked([](Friend& f) { f.untold = {{"a message is dropped", "Send a better one"}}; });
  ASSERT_TRUE(client->until([&] { return client->status["companion"]["newest"] == "a message is dropped"; }));
  EXPECT_EQ(client->status["companion"]["cure"], "Send a better one");
  EXPECT_EQ(client->status["companion"]["not_used"], 3);
  const std::scoped_lock lock(mutex);
  EXPECT_EQ(said, std::vector<std::string>{"a friend: a message is dropped. Send a better one."});
}
