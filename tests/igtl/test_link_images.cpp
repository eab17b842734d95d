// SPDX-License-Identifier: GPL-3.0-or-later
// Images out of a link and the pose of the probe into it, while a loop runs.
#include "peer.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/igtl/image_publisher.hpp"
#include "stylet/imaging/fluoroscope.hpp"

#include <igtl_image.h>

#include <algorithm>

using namespace stylet;
using namespace stylet::igtl;
using namespace stylet::test;

namespace {

/// An image as another program takes it from a message, with the OpenIGTLink library.
struct SeenImage {
  std::array<int, 3> size{};
  std::array<float, 3> spacing{};
  ::igtl::Matrix4x4 matrix{};  ///< directions and the middle of the image [mm] RAS
  std::vector<std::uint8_t> values;
};

SeenImage image_of(const Peer::Message& m) {
  igtl_image_header raw;
  std::memcpy(&raw, m.body.data(), sizeof raw);
  igtl_image_convert_byte_order(&raw);
  SeenImage seen;
  float origin[3], i[3], j[3], k[3];
  igtl_image_get_matrix(seen.spacing.data(), origin, i, j, k, &raw);
  for (int row = 0; row < 3; ++row) {
    seen.matrix[row][0] = i[row];
    seen.matrix[row][1] = j[row];
    seen.matrix[row][2] = k[row];
    seen.matrix[row][3] = origin[row];
  }
  seen.size = {raw.size[0], raw.size[1], raw.size[2]};
  EXPECT_EQ(raw.scalar_type, IGTL_IMAGE_STYPE_TYPE_UINT8);
  EXPECT_EQ(raw.coord, IGTL_IMAGE_COORD_RAS);
  seen.values.assign(m.body.begin() + IGTL_IMAGE_HEADER_SIZE, m.body.end());
  return seen;
}

/// An image of one grey value.
GreyPicture plain_image(std::uint8_t value) {
  GreyPicture image;
  image.columns = 64;
  image.rows = 32;
  image.pixels.assign(64 * 32, value);
  return image;
}

}  // namespace

TEST(LinkImages, pictures_of_the_fluoroscope_arrive_at_their_place_while_the_loop_steps) {
  TetMesh mesh = box_mesh({-40, -30, -35}, {60, 30, 45}, {10, 6, 8}, 0.0);
  assign_regions(mesh, {"prostate", "bladder"}, [](const Vec3& x) { return x.z() > 20 ? 1 : 0; });
  FluoroscopySettings settings;
  settings.pixels = 256;
  settings.angle_deg = 90.0;
  auto unit = Fluoroscope::create(mesh, settings);
  ASSERT_TRUE(unit);

  const auto link = opened(any_port());
  SpringRun run;
  ASSERT_TRUE(run.runner->start().ok());
  Moment moment = moment_at_rest(mesh);
  const auto publisher = ImagePublisher::start(
      *link,
      [&](GreyPicture& image) {
        moment.time_s += 0.05;
        image = (*unit)->expose(moment);
        return true;
      },
      30.0);
  ASSERT_TRUE(publisher);

  Peer peer = Peer::to(link->state().port);
  const std::int64_t steps_before = run.body->steps;
  std::vector<std::uint8_t> before;
  for (int k = 0; k < 40; ++k) {
    const auto message = peer.next("IMAGE", "Image_Reference");
    ASSERT_TRUE(message);
    const SeenImage seen = image_of(*message);
    ASSERT_EQ(seen.size, (std::array{256, 256, 1}));
    EXPECT_NE(seen.values, before) << "each has its own noise";
    before = seen.values;
    const double pixel = settings.field_mm / settings.pixels;
    EXPECT_NEAR(seen.spacing[0], pixel, 1e-6);
    // The detector is at the patient's left: columns run to posterior, rows to inferior, and the middle of the image is
    // the centre of the gland, in RAS.
    const Vec3 centre = (*unit)->geometry().centre_mm;
    const std::array<std::array<double, 4>, 3> expected{
        {{0, 0, 1, -centre.x()}, {-1, 0, 0, -centre.y()}, {0, -1, 0, centre.z()}}};
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 4; ++column)
        EXPECT_NEAR(seen.matrix[row][column], expected[row][column], 1e-4) << row << ' ' << column;
    EXPECT_LT(seen.values[(128 - 40) * 256 + 128], seen.values[(128 + 20) * 256 + 128]) << "contrast in the bladder";
  }
  EXPECT_GT(run.body->steps, steps_before + 40) << "the loop takes many steps from image to image";
  run.runner->stop();
}

TEST(LinkImages, of_images_that_come_too_fast_the_newest_are_sent_in_order) {
  LinkSettings settings = any_port();
  settings.images_hz = 50.0;
  const auto link = opened(settings);
  Peer peer = Peer::to(link->state().port);
  std::atomic<int> made{0};
  const Repeat maker([&] {
    for (int k = 0; k < 3; ++k)
      ASSERT_TRUE(link->publish_image(plain_image(static_cast<std::uint8_t>(std::min(255, ++made)))).ok());
  });
  int last = 0;
  int received = 0;
  while (last < 240) {
    const auto message = peer.next("IMAGE", "Image_Reference");
    ASSERT_TRUE(message);
    const int value = image_of(*message).values.front();
    ASSERT_GT(value, last);
    last = value;
    ++received;
  }
  EXPECT_LT(received, 160) << "of three that come at once, one or two";
}

TEST(LinkImages, who_connects_later_gets_the_last_image) {
  const auto link = opened(any_port());
  {
    Peer one = Peer::to(link->state().port);
    ASSERT_TRUE(link->publish_image(plain_image(9)).ok());
    ASSERT_TRUE(one.next("IMAGE", "Image_Reference"));
  }
  Peer two = Peer::to(link->state().port);
  const auto message = two.next("IMAGE", "Image_Reference");
  ASSERT_TRUE(message);
  EXPECT_EQ(image_of(*message).values, plain_image(9).pixels);
}

TEST(LinkImages, the_probe_is_moved_from_the_other_side_and_its_pose_goes_out) {
  const auto link = opened(any_port());
  EXPECT_FALSE(link->probe_pose());
  Peer tracker = Peer::to(link->state().port);
  Pose probe;
  {
    const Repeat stepper([&] { tracker.send(library_transform("StepperToReference", at(-1, -2, 3))); });
    ASSERT_TRUE(comes_true([&] {
      const auto pose = link->probe_pose();
      if (pose) probe = *pose;
      return pose.has_value();
    }));
  }
  EXPECT_TRUE(probe.origin.isApprox(Vec3(1, 2, 3))) << "LPS";
  EXPECT_EQ(link->state().poses, 0) << "the needle is not moved by it";
  EXPECT_TRUE(comes_true([&] { return link->state().probe_poses > 0; }));
  {
    Picture picture;
    picture.has_probe = true;
    picture.probe = plain(probe);
    Peer display = Peer::to(link->state().port);
    const Repeat publisher([&] { link->publish(picture); });
    const auto out = display.next("TRANSFORM", "ProbeToReference");
    ASSERT_TRUE(out);
    const auto m = matrix_of(*out);
    EXPECT_EQ((std::array{m[9], m[10], m[11]}), (std::array{-1.0F, -2.0F, 3.0F}));
  }
  tracker.send(library_status("Stepper", ::igtl::StatusMessage::STATUS_NOT_PRESENT));
  tracker.send(library_transform("StepperToReference", at(-5, -5, 5)));
  EXPECT_TRUE(comes_true([&] { return !link->probe_pose(); })) << "a stepper that is not ready moves nothing";
}

TEST(LinkImages, images_that_are_none_and_rates_that_are_none_are_refused) {
  const auto link = opened(any_port());
  EXPECT_FALSE(link->publish_image({}));
  GreyPicture image = plain_image(1);
  image.pixels.pop_back();
  const auto missing = link->publish_image(image);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("64 × 32 pixels with 2047 values"), std::string::npos)
      << missing.error().message();
  image.columns = 70000;
  EXPECT_FALSE(link->publish_image(image));
  EXPECT_FALSE(ImagePublisher::start(
      *link, [](GreyPicture&) { return false; }, 0.0));
  EXPECT_FALSE(ImagePublisher::start(
      *link, [](GreyPicture&) { return false; }, 1000.0));
}

TEST(LinkImages, a_source_without_a_newer_image_sends_none) {
  const auto link = opened(any_port());
  std::atomic<int> asked{0};
  const auto publisher = ImagePublisher::start(
      *link,
      [&](GreyPicture& image) {
        if (asked++ > 0) return false;
        image = plain_image(3);
        return true;
      },
      50.0);
  ASSERT_TRUE(publisher);
  Peer peer = Peer::to(link->state().port);
  ASSERT_TRUE(peer.next("IMAGE", "Image_Reference"));
  ASSERT_TRUE(comes_true([&] { return asked > 20; }));
  int images = 0;
  for (int k = 0; k < 3;) {
    const auto message = peer.next();
    ASSERT_TRUE(message);
    images += message->type == "IMAGE";
    k += message->type == "STATUS";
  }
  EXPECT_EQ(images, 0);
}
