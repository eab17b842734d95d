// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl/message_reader.hpp"

#include "library_messages.hpp"

#include <gtest/gtest.h>
#include <igtlPositionMessage.h>
#include <igtlStringMessage.h>
#include <igtl_util.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

using namespace stylet;
using namespace stylet::igtl;
using namespace stylet::test;
using namespace std::string_literals;
using Kind = Incoming::Kind;

namespace {

struct Read {
  std::vector<Incoming> messages;
  Result<> result = Ok{};
};

/// Reads the bytes in pieces of this size until the first error. Each piece is allocated by itself, so that a sanitizer
/// notices reading beyond it.
Read read(const Raw& bytes, std::size_t piece = 1 << 20, MessageReader reader = MessageReader{}) {
  Read r;
  for (std::size_t first = 0; first < bytes.size() && r.result; first += piece) {
    const Raw part(bytes.begin() + static_cast<std::ptrdiff_t>(first),
                   bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), first + piece)));
    r.result = reader.take(part, [&](const Incoming& m) { r.messages.push_back(m); });
  }
  return r;
}

Raw operator+(Raw a, const Raw& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The pose of a message that has one.
RasMatrix pose_in(const Incoming& m) { return m.poses.at(0).matrix.value(); }

/// Why the only message is refused; empty if it is not.
Refusal refusal_of(const Read& r) {
  if (!r.result || r.messages.size() != 1 || r.messages[0].kind != Kind::refused) return {};
  return r.messages[0].refusal;
}

Raw library_string(const char* name) {
  auto message = ::igtl::StringMessage::New();
  message->SetDeviceName(name);
  message->SetString("some text");
  return packed(*message);
}

/// A message with header version 2: an extended header of 12 bytes before the content, and metadata after it.
Raw version_2(const Raw& message, std::size_t metadata) {
  Raw m(message.begin(), message.begin() + 58);
  put(m, 0, 2, 2);
  m.resize(70);
  put(m, 58, 12, 2);
  put(m, 60, 2, 2);
  put(m, 62, metadata, 4);
  m.insert(m.end(), message.begin() + 58, message.end());
  m.resize(m.size() + 2 + metadata, 'x');
  seal(m);
  return m;
}

const std::array<float, 12> kMatrix{0, -1, 0, 0, 0, 1, -1, 0, 0, 1.5F, -2.5F, 3.5F};

}  // namespace

TEST(MessageReader, reads_what_the_library_sends_however_it_is_cut) {
  const Raw bytes = library_transform("HandleToReference", kMatrix) + library_string("Greeting") +
                    library_status("Tracker", 13) + library_transform("NeedleTipToReference", kMatrix);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{57}, std::size_t{106}, bytes.size()}) {
    const Read r = read(bytes, piece);
    ASSERT_TRUE(r.result) << r.result.error().message();
    ASSERT_EQ(r.messages.size(), 4U) << piece;
    EXPECT_EQ(r.messages[0].kind, Kind::pose);
    EXPECT_EQ(r.messages[0].name, "HandleToReference");
    EXPECT_EQ(pose_in(r.messages[0]), kMatrix);
    EXPECT_EQ(r.messages[1].kind, Kind::text);
    EXPECT_EQ(r.messages[1].text, "some text");
    EXPECT_EQ(r.messages[2].kind, Kind::status);
    EXPECT_EQ(r.messages[2].name, "Tracker");
    EXPECT_EQ(r.messages[2].code, 13);
    EXPECT_EQ(r.messages[3].name, "NeedleTipToReference") << "twenty bytes, without a zero";
  }
}

TEST(MessageReader, reads_version_2_headers_past_their_metadata) {
  for (const std::size_t metadata : {0, 1, 100}) {
    const Read r = read(version_2(library_transform("Handle", kMatrix), metadata));
    ASSERT_TRUE(r.result) << r.result.error().message();
    ASSERT_EQ(r.messages.size(), 1U);
    EXPECT_EQ(pose_in(r.messages[0]), kMatrix);
  }
  Raw wrong = version_2(library_transform("Handle", kMatrix), 4);
  put(wrong, 62, 0xFFFFFFFF, 4);
  seal(wrong);
  EXPECT_EQ(refusal_of(read(wrong)).kind, "length"s) << "more metadata than body";
  wrong = version_2(library_transform("Handle", kMatrix), 4);
  put(wrong, 58, 3, 2);
  seal(wrong);
  EXPECT_EQ(refusal_of(read(wrong)).kind, "length"s) << "an extended header shorter than itself";
}

TEST(MessageReader, messages_without_a_body_pass) {
  Raw request = library_string("Anything");
  request.resize(58);
  std::copy_n("GET_STATUS\0\0", 12, request.begin() + 2);
  seal(request);
  const Read r = read(request + request + library_transform("Handle", kMatrix), 13);
  ASSERT_TRUE(r.result);
  EXPECT_EQ(r.messages.size(), 3U);
}

TEST(MessageReader, a_length_beyond_the_limit_is_refused_before_anything_is_kept) {
  for (const std::uint64_t length : {~std::uint64_t{0}, std::uint64_t{1} << 63, std::uint64_t{1} << 40}) {
    for (const Raw& message : {library_string("Text"), library_transform("Handle", kMatrix)}) {
      Raw header(message.begin(), message.begin() + 58);
      put(header, 42, length, 8);
      EXPECT_FALSE(read(header).result) << length;
    }
  }
  Raw transform = library_transform("Handle", kMatrix);
  transform.resize(58 + MessageReader::kKept + 1);
  seal(transform);
  EXPECT_EQ(refusal_of(read(transform)).kind, "length"s) << "an image may be that long, a matrix may not";
  Raw image = library_string("Image");
  put(image, 42, 1000, 8);
  EXPECT_TRUE(read(image, 1 << 20, MessageReader({.longest = 1000})).result);
  EXPECT_FALSE(read(image, 1 << 20, MessageReader({.longest = 999})).result);
}

TEST(MessageReader, any_wrong_bit_of_a_body_is_seen) {
  const Raw good = library_transform("Handle", kMatrix);
  for (std::size_t bit = 58 * 8; bit < good.size() * 8; ++bit) {
    Raw bad = good;
    bad[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    ASSERT_EQ(refusal_of(read(bad)).kind, "checksum"s) << "bit " << bit;
  }
}

TEST(MessageReader, bodies_of_the_wrong_length_are_refused) {
  for (const std::size_t length : {std::size_t{0}, std::size_t{47}, std::size_t{49}, std::size_t{100}}) {
    Raw transform = library_transform("Handle", kMatrix);
    transform.resize(58 + length);
    seal(transform);
    EXPECT_EQ(refusal_of(read(transform)).kind, "length"s) << length;
  }
  for (const std::size_t length : {0, 1, 29}) {
    Raw status = library_status("Tracker", 1);
    status.resize(58 + length);
    seal(status);
    EXPECT_EQ(refusal_of(read(status)).kind, "length"s) << length;
  }
}

TEST(MessageReader, other_protocols_are_seen_at_once) {
  const std::string web = "GET / HTTP/1.1\r\nHost: 127.0.0.1:18944\r\nUser-Agent: something\r\nAccept: */*\r\n\r\n";
  EXPECT_FALSE(read(Raw(web.begin(), web.end())).result);
  EXPECT_FALSE(read(Raw(58, 0)).result);
  EXPECT_FALSE(read(Raw(58, 255)).result);
}

TEST(MessageReader, a_message_cut_short_is_no_message) {
  const Raw whole = library_transform("Handle", kMatrix);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Read r = read(Raw(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
    ASSERT_TRUE(r.result) << "the rest may still come";
    ASSERT_TRUE(r.messages.empty());
  }
}

TEST(MessageReader, a_message_that_is_refused_ends_only_itself) {
  Raw unsealed = library_transform("Handle", kMatrix);
  put(unsealed, 50, 0, 8);
  Raw newer = library_transform("Handle", kMatrix);
  put(newer, 0, 3, 2);
  Raw cut = library_transform("Handle", kMatrix);
  cut.pop_back();
  seal(cut);
  const Raw good = library_transform("Handle", kMatrix);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{13}, std::size_t{1000}}) {
    const Read r = read(unsealed + good + newer + good + cut + good, piece);
    ASSERT_TRUE(r.result) << r.result.error().message();
    std::string kinds;
    for (const Incoming& m : r.messages) kinds += m.kind == Kind::refused ? m.refusal.kind + "; "s : "pose; ";
    EXPECT_EQ(kinds, "checksum; pose; header version; pose; length; pose; ");
  }
}

TEST(MessageReader, no_bytes_whatever_do_harm) {
  std::mt19937 random(7);
  const auto number = [&random](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  const Raw good = library_transform("Handle", kMatrix) + library_status("Tracker", 1) + library_string("Text") +
                   version_2(library_transform("Handle", kMatrix), 20) + library_tools("TDATA", kMatrix) +
                   library_tools("QTDATA", kMatrix) + command("Stylet", 7, "reset", "");
  int refused = 0;
  for (int round = 0; round < 10'000; ++round) {
    Raw bytes = good;
    const bool sealed = round % 3 == 0;
    if (round % 10 == 9) {
      bytes.resize(number(400));
      for (auto& b : bytes) b = static_cast<std::uint8_t>(number(256));
    } else {
      for (std::size_t k = 0, changes = 1 + number(4); k < changes; ++k)
        bytes[number(sealed ? 106 : bytes.size())] = static_cast<std::uint8_t>(number(256));
    }
    if (sealed && bytes.size() >= 106) put(bytes, 50, crc64(bytes.data() + 58, 48, 0), 8);
    const Read r = read(bytes, 1 + number(200), MessageReader({.checksums = round % 2 == 0}));
    refused += r.result ? 0 : 1;
    for (const Incoming& m : r.messages) {
      ASSERT_LE(m.name.size(), 20U);
      ASSERT_EQ(m.kind == Kind::refused, !m.refusal.why.empty()) << "a refusal has a reason";
      ASSERT_EQ(m.kind == Kind::refused, !m.refusal.cure.empty()) << "and a cure";
      refused += m.kind == Kind::refused ? 1 : 0;
      for (const ToolPose& tool : m.poses) {
        ASSERT_LE(tool.name.size(), 20U);
        if (tool.matrix) (void)pose_of(*tool.matrix);
      }
    }
  }
  EXPECT_GT(refused, 2000);
}

namespace {

/// A POSITION of the library whose body ends after these bytes: 12 for the position alone, 24 with three parts of the
/// quaternion, 28 with all. The library itself packs them all and shortens nothing safely: for a shorter form it swaps
/// the bytes of parts that it has not allocated.
Raw library_position(const char* name, const Eigen::Quaternionf& q, std::size_t body) {
  auto message = ::igtl::PositionMessage::New();
  message->SetDeviceName(name);
  message->SetPackType(::igtl::PositionMessage::ALL);
  message->SetPosition(10, 20, -30);
  message->SetQuaternion(q.x(), q.y(), q.z(), q.w());
  Raw bytes = packed(*message);
  bytes.resize(58 + body);
  seal(bytes);
  return bytes;
}

}  // namespace

TEST(MessageReader, a_position_with_a_quaternion_is_a_pose) {
  const Eigen::Quaternionf q(Eigen::AngleAxisf(0.5F, Eigen::Vector3f(1, 2, 2).normalized()));
  for (const std::size_t body : {28U, 24U}) {
    const Read r = read(library_position("HandleToReference", q, body));
    ASSERT_TRUE(r.result) << r.result.error().message();
    ASSERT_EQ(r.messages.size(), 1U);
    EXPECT_EQ(r.messages[0].kind, Kind::pose);
    EXPECT_EQ(r.messages[0].type, "POSITION");
    const RasMatrix pose = pose_in(r.messages[0]);
    const Eigen::Map<const Eigen::Matrix<float, 3, 4>> matrix(pose.data());
    EXPECT_LT((matrix.leftCols<3>() - q.toRotationMatrix()).norm(), 1e-5F);
    EXPECT_EQ(matrix.col(3), Eigen::Vector3f(10, 20, -30));
  }
}

TEST(MessageReader, a_position_without_an_orientation_has_no_matrix) {
  const Read r = read(library_position("HandleToReference", Eigen::Quaternionf::Identity(), 12));
  ASSERT_TRUE(r.result);
  EXPECT_EQ(r.messages.at(0).poses.at(0).name, "HandleToReference");
  EXPECT_FALSE(r.messages[0].poses[0].matrix);
  const Read stretched = read(library_position("HandleToReference", Eigen::Quaternionf(2, 0, 0, 0), 28));
  EXPECT_FALSE(stretched.messages.at(0).poses.at(0).matrix);
}

TEST(MessageReader, tracking_data_have_a_pose_for_each_tool) {
  for (const char* type : {"TDATA", "QTDATA"}) {
    const Read r = read(library_tools(type, kMatrix));
    ASSERT_TRUE(r.result) << r.result.error().message();
    ASSERT_EQ(r.messages.at(0).kind, Kind::pose);
    EXPECT_EQ(r.messages[0].name, "Tracker");
    ASSERT_EQ(r.messages[0].poses.size(), 2U);
    EXPECT_EQ(r.messages[0].poses[0].name, "Stylus");
    EXPECT_EQ(r.messages[0].poses[1].name, "HandleToReference");
    const RasMatrix pose = r.messages[0].poses[1].matrix.value();
    for (std::size_t k = 0; k < pose.size(); ++k) EXPECT_NEAR(pose[k], kMatrix[k], 1e-6) << type << " " << k;
  }
  Raw odd = library_tools("TDATA", kMatrix);
  odd.pop_back();
  seal(odd);
  EXPECT_EQ(refusal_of(read(odd)).kind, "length"s);
}

TEST(MessageReader, a_command_has_its_number_its_name_and_its_text) {
  for (const std::size_t metadata : {std::size_t{0}, std::size_t{9}}) {
    const Read r = read(version_2(command("Stylet", 70'000, "Choose", "hole D4"), metadata));
    ASSERT_TRUE(r.result);
    ASSERT_EQ(r.messages.at(0).kind, Kind::text);
    EXPECT_EQ(r.messages[0].command_id, 70'000U);
    EXPECT_EQ(r.messages[0].command_name, "Choose");
    EXPECT_EQ(r.messages[0].text, "hole D4");
  }
  Raw longer = command("Stylet", 1, "Choose", "hole D4");
  put(longer, 58 + 134, 8, 4);
  seal(longer);
  EXPECT_EQ(refusal_of(read(longer)).kind, "length"s) << "a text beyond the end of the message";
}

TEST(MessageReader, a_wrong_checksum_is_taken_where_checksums_are_off) {
  Raw bytes = library_transform("HandleToReference", kMatrix);
  put(bytes, 50, 0, 8);
  const Refusal refusal = refusal_of(read(bytes));
  EXPECT_EQ(refusal.why, "its checksum is 0");
  EXPECT_NE(refusal.cure.find("--igtl-no-checksum"), std::string::npos) << refusal.cure;
  put(bytes, 50, 1, 8);
  EXPECT_EQ(refusal_of(read(bytes)).why, "its body does not match its checksum");
  const Read taken = read(bytes, 1 << 20, MessageReader({.checksums = false}));
  ASSERT_TRUE(taken.result);
  EXPECT_EQ(pose_in(taken.messages.at(0)), kMatrix);
}

TEST(MessageReader, another_version_of_the_header_is_refused_with_the_versions_that_are_read) {
  Raw bytes = library_transform("HandleToReference", kMatrix);
  put(bytes, 0, 3, 2);
  const Refusal refusal = refusal_of(read(bytes));
  EXPECT_EQ(refusal.why, "its header has version 3, which is not read");
  EXPECT_NE(refusal.cure.find("header version 1 or 2"), std::string::npos) << refusal.cure;
}

TEST(MessageReader, messages_of_other_programs_are_taken_or_refused_with_the_reason) {
  const char* given = std::getenv("STYLET_SHARED_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(given != nullptr ? given : STYLET_SHARED_DATA_DEFAULT) / "found3";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no messages at " << folder << " (set STYLET_SHARED_DATA)";
  const auto bytes_of = [&](const char* name) {
    std::ifstream file(folder / name, std::ios::binary);
    return Raw(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  };
  const Read position = read(bytes_of("k16_position.bin"));
  ASSERT_TRUE(position.result) << position.result.error().message();
  EXPECT_EQ(position.messages.at(0).kind, Kind::pose);
  EXPECT_EQ(refusal_of(read(bytes_of("k16_transform_v1_crc0.bin"))).kind, "checksum"s);
  const Read taken = read(bytes_of("k16_transform_v1_crc0.bin"), 1 << 20, MessageReader({.checksums = false}));
  ASSERT_TRUE(taken.result) << taken.result.error().message();
  EXPECT_EQ(taken.messages.at(0).kind, Kind::pose);
  EXPECT_EQ(refusal_of(read(bytes_of("k16_transform_header_v3.bin"))).kind, "header version"s);
}
