// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures for a companion, another program that may move the probe.
#include "rectum_case.hpp"
#include "stylet/probe/probe_place.hpp"

#include <mutex>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A companion that looks at pictures and holds the probe while it has a pose for it.
class Onlooker final : public serve::Companion {
 public:
  [[nodiscard]] std::string name() const override { return "an onlooker"; }
  [[nodiscard]] std::unique_ptr<Device> device() override { return nullptr; }
  [[nodiscard]] std::string why_no_pose() const override { return {}; }
  void show(const serve::Scene& /*scene*/) override {}
  void show(const Snapshot& /*snapshot*/, const DeviceSnapshot& /*device*/) override {}
  void show(const Eigen::Ref<const Eigen::Matrix3Xf>& /*displacement*/) override {}
  [[nodiscard]] bool wants_images() const override { return wants; }
  void show(const serve::LiveImage& image) override {
    const std::scoped_lock lock(mutex_);
    image_ = image;
    ++images_;
  }
  [[nodiscard]] std::optional<Pose> probe_pose() override {
    const std::scoped_lock lock(mutex_);
    return hold_;
  }

  void hold(const std::optional<Pose>& pose) {
    const std::scoped_lock lock(mutex_);
    hold_ = pose;
  }
  [[nodiscard]] int images() const {
    const std::scoped_lock lock(mutex_);
    return images_;
  }
  [[nodiscard]] serve::LiveImage image() const {
    const std::scoped_lock lock(mutex_);
    return image_;
  }
  std::atomic<bool> wants = false;

 private:
  mutable std::mutex mutex_;
  serve::LiveImage image_;
  int images_ = 0;
  std::optional<Pose> hold_;
};

struct Watched {
  std::shared_ptr<Onlooker> onlooker = std::make_shared<Onlooker>();
  Serving serving;
  std::unique_ptr<LiveClient> page;

  explicit Watched(const serve::CaseSource& source)
      : serving([&](serve::ServerSettings& s) {
          s.session.cases = {source};
          s.session.companion = onlooker;
          s.session.say = [this](const std::string& text) {
            const std::scoped_lock lock(mutex);
            said += text;
          };
        }),
        page(ready_client(serving)) {
    EXPECT_TRUE(page->take());
  }
  /// Whether the last picture shows the plane through a pose of the probe, seen along its axis.
  [[nodiscard]] bool shows(const Pose& pose) const {
    const serve::LiveImage image = onlooker->image();
    if (!image.in_patient || !image.probe) return false;
    const GreyPicture& picture = *image.in_patient;
    const Vec3 axis = pose.rotation * Vec3::UnitZ();
    return (image.probe->origin - pose.origin).norm() < 1e-6 &&
           image.probe->rotation.angularDistance(pose.rotation) < 1e-6 &&
           std::abs(axis.dot(picture.corner_mm - pose.origin)) < 1e-6 && std::abs(axis.dot(picture.right)) < 1e-6 &&
           std::abs(axis.dot(picture.down)) < 1e-6;
  }
  [[nodiscard]] const nlohmann::json& told() const { return page->status["image"]; }

  std::mutex mutex;
  std::string said;
};

}  // namespace

TEST(CompanionImages, come_while_it_wants_them_and_the_pages_look_at_none) {
  Watched at(case_with_rectum());
  LiveClient& page = *at.page;
  EXPECT_EQ(at.onlooker->images(), 0);
  at.onlooker->wants = true;
  ASSERT_TRUE(page.until([&] { return at.onlooker->images() > 3; }));
  EXPECT_EQ(page.images, 0u);
  EXPECT_EQ(at.told()["shown"], "none");
  const serve::LiveImage image = at.onlooker->image();
  ASSERT_TRUE(image.in_patient && image.probe);
  EXPECT_TRUE(at.shows(*image.probe));
  EXPECT_GT(*std::max_element(image.in_patient->pixels.begin(), image.in_patient->pixels.end()), 100);
  EXPECT_GT(image.in_patient->time_s, 0.0);
  // The companion also gets the pictures that a page looks at.
  page.command(R"({"do":"image","show":"xray"})");
  ASSERT_TRUE(page.until([&] {
    const auto now = at.onlooker->image();
    return page.images > 0 && now.in_patient && now.in_patient->columns == 512 && now.in_patient->rows == 512;
  }));
  page.command(R"({"do":"image","show":"none"})");
  ASSERT_TRUE(page.until([&] { return at.onlooker->image().in_patient->columns != 512; }));
  at.onlooker->wants = false;
  const double then = page.time_s;
  ASSERT_TRUE(page.until([&] { return page.time_s > then + 1.0; }));
  const int last = at.onlooker->images();
  ASSERT_TRUE(page.until([&] { return page.time_s > then + 2.0; }));
  EXPECT_EQ(at.onlooker->images(), last);
}

TEST(CompanionImages, follow_the_probe_that_it_holds) {
  Watched at(case_with_rectum());
  LiveClient& page = *at.page;
  at.onlooker->wants = true;
  ASSERT_TRUE(page.until([&] { return at.onlooker->image().probe.has_value(); }));
  EXPECT_EQ(at.told()["probe_device"], "page");
  Pose pose = *at.onlooker->image().probe;
  pose.origin += Vec3(0.0, -2.0, 4.0);
  at.onlooker->hold(pose);
  ASSERT_TRUE(page.until([&] { return at.shows(pose) && at.told()["probe_device"] == "an onlooker"; }));
  EXPECT_EQ(at.told()["probe_problem"], "");
  // The page cannot move the stepper meanwhile, but fill the balloon.
  page.command(R"({"do":"set","key":"probe.lift_mm","value":8})");
  EXPECT_SAYS(page.notice(1), "a tracker moves the probe");
  page.command(R"({"do":"image","show":"transverse"})");
  page.command(R"({"do":"set","key":"probe.balloon_mm","value":1})");
  ASSERT_TRUE(page.until([&] { return page.images > 0 && page.image["probe"]["balloon_mm"] == 1.0; }));
  EXPECT_NEAR(page.image["probe"]["lift_mm"], 2.0, 1e-6) << "the page shows where the tracker holds it";
  // Beside the rectum the probe stays, and the page says why.
  at.onlooker->hold(Pose{pose.origin + 40.0 * Vec3::UnitX(), pose.rotation});
  ASSERT_TRUE(page.until([&] { return at.told()["probe_problem"].get<std::string>().size() > 0; }));
  EXPECT_NE(at.told()["probe_problem"].get<std::string>().find("40 mm to the patient's left"), std::string::npos);
  EXPECT_TRUE(at.shows(pose));
  // When it lets go, the probe stays where it was, and the page moves it again.
  at.onlooker->hold(std::nullopt);
  ASSERT_TRUE(page.until([&] { return at.told()["probe_device"] == "page" && at.told()["probe_problem"] == ""; }));
  EXPECT_TRUE(at.shows(pose));
  page.command(R"({"do":"set","key":"probe.lift_mm","value":3})");
  ASSERT_TRUE(page.until([&] { return at.shows({pose.origin - Vec3::UnitY(), pose.rotation}); }));
}

TEST(CompanionImages, that_cannot_be_are_explained_where_the_server_was_started) {
  Watched at(box_case("without a rectum"));
  at.onlooker->wants = true;
  ASSERT_TRUE(at.page->until([&] {
    const std::scoped_lock lock(at.mutex);
    return at.said.find("an onlooker gets no pictures: it has no rectum") != std::string::npos;
  }));
  EXPECT_EQ(at.onlooker->images(), 0);
}
