// SPDX-License-Identifier: GPL-3.0-or-later
// Written messages are read by the OpenIGTLink library, which checks the checksums.
#include "igtl/message_writer.hpp"

#include "library_messages.hpp"

#include <gtest/gtest.h>
#include <igtlImageMessage.h>
#include <igtlPointMessage.h>
#include <igtlStringMessage.h>
#include <igtl_header.h>
#include <igtl_ndarray.h>
#include <igtl_polydata.h>

#include <chrono>
#include <cstring>

using namespace stylet;
using namespace stylet::igtl;
using namespace stylet::test;
using TissueSurface = stylet::igtl::Surface;

namespace {

/// Reads one complete message in `bytes` with the library.
template <class Message>
typename Message::Pointer unpacked(const Bytes& bytes, const std::string& type, const std::string& name) {
  auto header = ::igtl::MessageHeader::New();
  header->InitPack();
  EXPECT_GE(bytes.size(), static_cast<std::size_t>(header->GetPackSize()));
  std::memcpy(header->GetPackPointer(), bytes.data(), static_cast<std::size_t>(header->GetPackSize()));
  header->Unpack();
  EXPECT_EQ(header->GetDeviceType(), type);
  EXPECT_EQ(header->GetDeviceName(), name);
  EXPECT_EQ(static_cast<std::size_t>(header->GetBodySizeToRead()) + 58, bytes.size());
  auto stamp = ::igtl::TimeStamp::New();
  header->GetTimeStamp(stamp);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_NEAR(stamp->GetTimeStamp(), std::chrono::duration<double>(now).count(), 60.0);
  auto message = Message::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  std::memcpy(message->GetPackBodyPointer(), bytes.data() + 58, bytes.size() - 58);
  EXPECT_NE(message->Unpack(1) & ::igtl::MessageBase::UNPACK_BODY, 0) << "checksum";
  return message;
}

}  // namespace

TEST(MessageWriter, transform) {
  Bytes bytes;
  add_transform(bytes, "NeedleTipToReference", {{10, 20, 30}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)});
  const auto message = unpacked<::igtl::TransformMessage>(bytes, "TRANSFORM", "NeedleTipToReference");
  ::igtl::Matrix4x4 m;
  message->GetMatrix(m);
  // The axes point to posterior, superior and the left, which are −y, z and −x in RAS.
  const float expected[4][4] = {{0, 0, -1, -10}, {-1, 0, 0, -20}, {0, 1, 0, 30}, {0, 0, 0, 1}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(m[i][j], expected[i][j], 1e-6) << i << ' ' << j;
}

TEST(MessageWriter, names_of_more_than_twenty_bytes_are_cut) {
  Bytes bytes;
  add_transform(bytes, "NeedleBaseToReference", Pose{});
  unpacked<::igtl::TransformMessage>(bytes, "TRANSFORM", "NeedleBaseToReferenc");
  EXPECT_EQ(cut_name("NeedleBaseToReference"), "NeedleBaseToReferenc");
}

TEST(MessageWriter, force_and_torque) {
  Bytes bytes;
  add_wrench(bytes, "BaseForce", {{1, 2, 3}, {40, 50, 60}});
  // The library's class for NDARRAY frees memory with the wrong delete, so its C functions are used.
  unpacked<::igtl::MessageBase>(bytes, "NDARRAY", "BaseForce");
  igtl_ndarray_info info;
  igtl_ndarray_init_info(&info);
  Bytes body(bytes.begin() + 58, bytes.end());
  ASSERT_EQ(igtl_ndarray_unpack(IGTL_TYPE_PREFIX_NONE, body.data(), &info, body.size()), 1);
  EXPECT_EQ(info.type, IGTL_NDARRAY_STYPE_TYPE_FLOAT64);
  ASSERT_EQ(info.dim, 1);
  ASSERT_EQ(info.size[0], 6);
  std::array<double, 6> values{};
  std::memcpy(values.data(), info.array, sizeof values);
  EXPECT_EQ(values, (std::array<double, 6>{-1, -2, 3, -40, -50, 60}));
  igtl_ndarray_free_info(&info);
}

TEST(MessageWriter, text) {
  Bytes bytes;
  add_string(bytes, "BaseForce", R"({"fresh": true})");
  EXPECT_STREQ(unpacked<::igtl::StringMessage>(bytes, "STRING", "BaseForce")->GetString(), R"({"fresh": true})");
}

TEST(MessageWriter, points) {
  Bytes bytes;
  const std::array<Triple, 3> shaft{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  add_points(bytes, "NeedleShaft", shaft);
  const auto message = unpacked<::igtl::PointMessage>(bytes, "POINT", "NeedleShaft");
  ASSERT_EQ(message->GetNumberOfPointElement(), 3);
  ::igtl::PointElement::Pointer point;
  message->GetPointElement(2, point);
  float x = 0;
  float y = 0;
  float z = 0;
  point->GetPosition(x, y, z);
  EXPECT_EQ((std::array{x, y, z}), (std::array{-7.0F, -8.0F, 9.0F}));
  EXPECT_STREQ(point->GetName(), "NeedleShaft-2");
}

TEST(MessageWriter, surface) {
  TissueSurface surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  surface.triangles = std::make_shared<const TissueSurface::Triangles>(TissueSurface::Triangles{{0, 2, 1}, {0, 1, 3}});
  Bytes bytes;
  add_surface(bytes, "TissueSurface", surface);
  // The library's class for this message leaks memory, so its C functions are used.
  unpacked<::igtl::MessageBase>(bytes, "POLYDATA", "TissueSurface");
  Bytes body(bytes.begin() + 58, bytes.end());
  igtl_polydata_info info;
  igtl_polydata_init_info(&info);
  ASSERT_EQ(igtl_polydata_unpack(IGTL_TYPE_PREFIX_NONE, body.data(), &info, body.size()), 1);
  ASSERT_EQ(info.header.npoints, 4U);
  EXPECT_EQ(std::vector<float>(info.points, info.points + 12),
            (std::vector<float>{0, 0, 0, -1, 0, 0, 0, -2, 0, 0, 0, 3}));
  ASSERT_EQ(info.header.npolygons, 2U);
  ASSERT_EQ(info.header.size_polygons, 32U);
  EXPECT_EQ(std::vector<igtl_uint32>(info.polygons, info.polygons + 8),
            (std::vector<igtl_uint32>{3, 0, 2, 1, 3, 0, 1, 3}));
  igtl_polydata_free_info(&info);
}

TEST(MessageWriter, image) {
  GreyPicture image;
  image.columns = 3;
  image.rows = 2;
  image.mm_per_pixel = 0.5;
  image.corner_mm = {10, 20, 30};
  image.right = {0, 1, 0};  // to posterior
  image.down = {0, 0, -1};  // to inferior
  image.pixels = {1, 2, 3, 4, 5, 6};
  Bytes bytes;
  add_image(bytes, "Image_Reference", image);
  const auto message = unpacked<::igtl::ImageMessage>(bytes, "IMAGE", "Image_Reference");
  int width = 0, height = 0, slices = 0;
  message->GetDimensions(width, height, slices);
  EXPECT_EQ((std::array{width, height, slices}), (std::array{3, 2, 1}));
  EXPECT_EQ(message->GetScalarType(), ::igtl::ImageMessage::TYPE_UINT8);
  EXPECT_EQ(message->GetNumComponents(), 1);
  EXPECT_EQ(message->GetCoordinateSystem(), ::igtl::ImageMessage::COORDINATE_RAS);
  const auto* values = static_cast<const std::uint8_t*>(message->GetScalarPointer());
  EXPECT_EQ(std::vector<std::uint8_t>(values, values + 6), image.pixels);
  std::array<float, 3> spacing{};
  message->GetSpacing(spacing.data());
  EXPECT_EQ(spacing, (std::array{0.5F, 0.5F, 0.5F}));
  // The library gives directions of unit length and the middle of the image as the origin, RAS: one pixel to posterior
  // and half a pixel to inferior from the first.
  ::igtl::Matrix4x4 m;
  message->GetMatrix(m);
  const float expected[4][4] = {{0, 0, 1, -10}, {-1, 0, 0, -20.5F}, {0, -1, 0, 29.75F}, {0, 0, 0, 1}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(m[i][j], expected[i][j], 1e-5) << i << ' ' << j;
}

TEST(MessageWriter, heartbeat) {
  Bytes bytes;
  add_status(bytes, "Stylet", StatusCode::not_ready, "no picture");
  const auto message = unpacked<::igtl::StatusMessage>(bytes, "STATUS", "Stylet");
  EXPECT_EQ(message->GetCode(), ::igtl::StatusMessage::STATUS_NOT_READY);
  EXPECT_STREQ(message->GetStatusString(), "no picture");
  bytes.clear();
  add_status(bytes, "Stylet", StatusCode::ok, "");
  EXPECT_EQ(unpacked<::igtl::StatusMessage>(bytes, "STATUS", "Stylet")->GetCode(), ::igtl::StatusMessage::STATUS_OK);
}
