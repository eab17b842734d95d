// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace stylet;
using namespace stylet::serve;

namespace {

/// Reads the values of an encoded message in their order.
struct Reader {
  const wire::Bytes& bytes;
  std::size_t at = 0;
  template <class T>
  T take() {
    T value{};
    EXPECT_LE(at + sizeof value, bytes.size());
    if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  }
  std::uint32_t count() { return take<std::uint32_t>(); }
  float number() { return take<float>(); }
  [[nodiscard]] bool at_end() const { return at == bytes.size(); }
};

wire::Bytes message(std::uint32_t kind, const void* data, std::size_t size) {
  wire::Bytes bytes(8 + size);
  std::memcpy(bytes.data(), &kind, 4);
  if (size > 0) std::memcpy(bytes.data() + 8, data, size);
  return bytes;
}
wire::Bytes hand(std::array<float, 5> values) { return message(16, values.data(), sizeof values); }
wire::Bytes command(const std::string& text) { return message(17, text.data(), text.size()); }

const Command* as_command(const std::optional<std::variant<HandTarget, Command, wire::Seen>>& decoded) {
  return decoded ? std::get_if<Command>(&*decoded) : nullptr;
}

}  // namespace

TEST(Wire, a_scene_is_its_text_padded_and_its_surfaces) {
  const Scene scene{"{\"a\": 1}x", {1, 2, 3, 4, 5, 6}, {0, 1, 0}};
  const wire::Bytes bytes = wire::encode(scene, 5);
  Reader r{bytes};
  EXPECT_EQ(r.count(), 1u);
  EXPECT_EQ(r.count(), 5u);
  EXPECT_EQ(r.count(), 12u);
  EXPECT_EQ(r.count(), 2u);
  EXPECT_EQ(r.count(), 1u);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()) + r.at, 12), "{\"a\": 1}x   ");
  r.at += 12;
  for (const float x : {1.F, 2.F, 3.F, 4.F, 5.F, 6.F}) EXPECT_EQ(r.number(), x);
  for (const std::uint32_t k : {0U, 1U, 0U}) EXPECT_EQ(r.count(), k);
  EXPECT_TRUE(r.at_end());
}

TEST(Wire, a_frame_has_everything_where_the_protocol_says) {
  LiveFrame f;
  f.time_s = 1.25;
  f.bits = LiveFrame::paused | LiveFrame::trusted;
  f.step.flags = 9;
  f.step.tip_state = TipState::cutting;
  f.step.sticking = 3;
  f.step.iterations = 4;
  f.steps = 1250;
  f.missed = 2;
  f.step.base_depth_mm = 31.5;
  f.step.force_axial_N = 1.5;
  f.step.force_sagittal_N = -0.25;
  f.step.force_lateral_N = 0.125;
  f.step.torque_Nmm = {1, 2, 3};
  f.step.tip_mm = {4, 5, 6};
  f.step.base.origin = {7, 8, 9};
  f.step.base.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  f.roll_deg = 10;
  f.tilt_left_deg = 11;
  f.tilt_anterior_deg = 12;
  f.left_out_N = 0.75;
  f.tip_error = TipError{{-0.5, 0.25, -3.5}, 66.5};
  f.centreline = {1, 1, 1, 2, 2, 2};
  f.resting.assign(3 * Snapshot::kRestingPoints, 5);
  f.contacts.push_back({{1, 2, 3}, {4, 5, 6}, 7.0, true, true});
  Eigen::Matrix3Xf u(3, 2);
  u << 0.5F, -1.F, 0.F, 2.F, 0.001F, 0.F;
  set_displacement(f, u);
  Step before;
  before.time_s = 1.0;
  before.base_depth_mm = 30.0;
  before.force_axial_N = 1.25;
  before.force_sagittal_N = 0.5;
  before.force_lateral_N = 0.25;
  before.step_us = 60.0;
  before.tip_state = TipState::pressing;
  before.flags = 1;
  const std::vector<Step> samples{before};

  const wire::Bytes bytes = wire::encode(f, samples, true, 77);
  Reader r{bytes};
  EXPECT_EQ(r.count(), 2u);
  EXPECT_EQ(r.count(), 77u);
  EXPECT_EQ(r.take<double>(), 1.25);
  EXPECT_EQ(r.count(), 1u + 4u + 8u + 16u);  // paused, trusted, displaced, the whole curve
  for (const std::uint32_t value : {9U, 2U, 3U, 4U, 1250U, 2U}) EXPECT_EQ(r.count(), value);
  for (const float value : {31.5F, 1.5F, -0.25F, 0.125F, 1.F,  2.F,   3.F,  4.F,  5.F,  6.F,  7.F,
                            8.F,   9.F,  0.5F,   -0.5F,  0.5F, -0.5F, 10.F, 11.F, 12.F, 0.75F})
    EXPECT_EQ(r.number(), value);
  const float unit = r.number();
  for (const float value : {-0.5F, 0.25F, -3.5F, 66.5F}) EXPECT_EQ(r.number(), value);
  for (const std::uint32_t value : {2U, 1U, 1U, 2U, 1U}) EXPECT_EQ(r.count(), value);
  for (const float value : {1.F, 1.F, 1.F, 2.F, 2.F, 2.F}) EXPECT_EQ(r.number(), value);
  for (int k = 0; k < 51; ++k) EXPECT_EQ(r.number(), 5.F);
  for (const float value : {1.F, 2.F, 3.F, 4.F, 5.F, 6.F, 7.F}) EXPECT_EQ(r.number(), value);
  EXPECT_EQ(r.count(), 3u);
  for (const float value : {-0.25F, 30.F, 1.25F, 0.5F, 0.25F, 60.F, 1.F, 1.F}) EXPECT_EQ(r.number(), value);
  for (Eigen::Index k = 0; k < 2; ++k)
    for (Eigen::Index c = 0; c < 3; ++c)
      EXPECT_NEAR(unit * static_cast<float>(r.take<std::int16_t>()), u(c, k), 0.5F * unit);
  EXPECT_TRUE(r.at_end());
}

TEST(Wire, a_tip_that_is_not_in_the_tissue_has_an_error_that_is_not_a_number) {
  const wire::Bytes bytes = wire::encode(LiveFrame{}, {}, false, 1);
  Reader r{bytes, 132};  // docs/live_protocol.md
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(std::isnan(r.number()));
  for (int k = 0; k < 5; ++k) EXPECT_EQ(r.count(), 0U);
  EXPECT_TRUE(r.at_end());
}

TEST(Wire, displacements_of_any_size_fit_and_those_that_are_no_numbers_are_not_shown) {
  LiveFrame f;
  Eigen::Matrix3Xf u = Eigen::Matrix3Xf::Zero(3, 2);
  u(1, 1) = -250.0F;  // mm
  set_displacement(f, u);
  ASSERT_EQ(f.displacement.size(), 6u);
  EXPECT_NEAR(f.displacement[4] * f.unit_mm, -250.0, 0.01);
  u(0, 0) = std::numeric_limits<float>::quiet_NaN();
  set_displacement(f, u);
  EXPECT_TRUE(f.displacement.empty());
}

TEST(Wire, a_dose_has_its_grid_and_its_values) {
  serve::LiveDose dose;
  dose.size = {2, 1, 3};
  dose.origin_mm = Vec3(1, 2, 3);
  dose.spacing_mm = 1.5;
  dose.values = {1, 2, 3, 4, 5, 65535};
  const wire::Bytes bytes = wire::encode(dose, 7);
  Reader read{bytes};
  EXPECT_EQ(read.count(), 10u);
  EXPECT_EQ(read.count(), 7u);
  for (const std::uint32_t size : {2u, 1u, 3u}) EXPECT_EQ(read.count(), size);
  for (const float number : {1.0F, 2.0F, 3.0F, 1.5F, 0.1F}) EXPECT_EQ(read.number(), number);
  for (const std::uint16_t value : dose.values) EXPECT_EQ(read.take<std::uint16_t>(), value);
  EXPECT_TRUE(read.at_end());
}

TEST(Wire, a_picture_has_its_text_and_its_values) {
  const serve::LiveImage image{R"({"modality":"xray"})", 2, 3, {0, 1, 2, 3, 4, 255}};
  const wire::Bytes bytes = wire::encode(image, 9);
  Reader read{bytes};
  EXPECT_EQ(read.count(), 11u);
  EXPECT_EQ(read.count(), 9u);
  EXPECT_EQ(read.count(), image.text.size());
  EXPECT_EQ(read.count(), 2u);
  EXPECT_EQ(read.count(), 3u);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()) + read.at, image.text.size()), image.text);
  read.at += image.text.size();
  for (const std::uint8_t value : image.pixels) EXPECT_EQ(read.take<std::uint8_t>(), value);
  EXPECT_TRUE(read.at_end());
}

TEST(Wire, a_hand_is_taken_as_it_is_said) {
  const auto decoded = wire::decode(hand({12.5F, 20.F, 90.F, -1.F, 2.F}));
  ASSERT_TRUE(decoded);
  const auto* target = std::get_if<HandTarget>(&*decoded);
  ASSERT_NE(target, nullptr);
  EXPECT_EQ(target->depth_mm, 12.5);
  EXPECT_EQ(target->speed_mm_per_s, 20.0);
  EXPECT_EQ(target->roll_deg, 90.0);
  EXPECT_EQ(target->tilt_left_deg, -1.0);
  EXPECT_EQ(target->tilt_anterior_deg, 2.0);
  EXPECT_FALSE(target->rest);
}

TEST(Wire, commands_carry_what_they_need) {
  struct Case {
    const char* text;
    Command expected;
  };
  for (const Case& c :
       {Case{R"({"do":"hole","hole":"d3.5"})", {Command::Do::hole, "d3.5", 0.0}},
        Case{R"({"do":"seek","time_s":1.5})", {Command::Do::seek, "", 1.5}},
        Case{R"({"do":"predict","on":1})", {Command::Do::predict, "", 1.0}},
        Case{R"({"do":"needle","index":3})", {Command::Do::needle, "", 3.0}},
        Case{R"({"do":"set","key":"probe.lift_mm","value":8.5})", {Command::Do::set, "probe.lift_mm", 8.5}}}) {
    const auto decoded = wire::decode(command(c.text));
    const Command* taken = as_command(decoded);
    ASSERT_NE(taken, nullptr) << c.text;
    EXPECT_EQ(taken->what, c.expected.what) << c.text;
    EXPECT_EQ(taken->text, c.expected.text) << c.text;
    EXPECT_EQ(taken->number, c.expected.number) << c.text;
  }
  for (const char* name : {"take", "release", "reset", "pause", "resume", "live", "drawn", "drop", "undo", "clear"})
    EXPECT_NE(as_command(wire::decode(command(std::string(R"({"do":")") + name + "\"}"))), nullptr) << name;
}

TEST(Wire, a_coarse_displacement_has_half_the_bytes_and_its_own_unit) {
  LiveFrame frame;
  frame.unit_mm = 0.001;
  frame.displacement = {1270, -1270, 5, 14, -16, 0};
  const wire::Bytes fine = wire::encode(frame, {}, false, 1);
  const wire::Bytes coarse = wire::encode(frame, {}, false, 1, true);
  EXPECT_EQ(coarse.size() + 6, fine.size());
  Reader bits{coarse, 16};
  EXPECT_EQ(bits.count(), LiveFrame::displaced | LiveFrame::coarse);
  Reader unit{coarse, 128};
  EXPECT_NEAR(unit.number(), 0.01, 1e-9);
  Reader values{coarse, coarse.size() - 6};
  for (const int u : {127, -127, 1, 1, -2, 0}) EXPECT_EQ(int{values.take<std::int8_t>()}, u);
  frame.displacement = {3, -4, 0, 0, 0, 0};
  const wire::Bytes small = wire::encode(frame, {}, false, 1, true);
  Reader same{small, 128};
  EXPECT_NEAR(same.number(), 0.001, 1e-9) << "not finer than it is";
}

TEST(Wire, a_page_says_which_message_it_has_taken_up) {
  const std::uint32_t number = 7;
  const auto decoded = wire::decode(message(18, &number, sizeof number));
  ASSERT_TRUE(decoded);
  const auto* seen = std::get_if<wire::Seen>(&*decoded);
  ASSERT_NE(seen, nullptr);
  EXPECT_EQ(seen->number, 7u);
  EXPECT_FALSE(wire::decode(message(18, &number, 3)));
  EXPECT_FALSE(wire::decode(message(18, nullptr, 0)));
}

TEST(Wire, what_is_malformed_is_nothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(wire::decode({}));
  EXPECT_FALSE(wire::decode(wire::Bytes(7)));
  EXPECT_FALSE(wire::decode(message(0, nullptr, 0)));
  EXPECT_FALSE(wire::decode(message(16, nullptr, 0)));
  EXPECT_FALSE(wire::decode(message(2, nullptr, 0))) << "only servers send these";
  EXPECT_FALSE(wire::decode(hand({nan, 20, 0, 0, 0})));
  EXPECT_FALSE(wire::decode(hand({1, inf, 0, 0, 0})));
  EXPECT_FALSE(wire::decode(hand({1, -20, 0, 0, 0}))) << "a speed below zero";
  wire::Bytes longer = hand({1, 20, 0, 0, 0});
  longer.push_back(std::byte{0});
  EXPECT_FALSE(wire::decode(longer));
  for (const char* text :
       {"", "{", "[]", "null", "{}", R"({"do":1})", R"({"do":"fly"})", R"({"do":"hole"})", R"({"do":"hole","hole":4})",
        R"({"do":"seek","time_s":"now"})", R"({"do":"step"})", R"({"do":"predict"})", R"({"do":"needle"})",
        R"({"do":"seek","time_s":1e300})", R"({"do":"take")", R"({"do":"set","key":"probe.lift_mm"})",
        R"({"do":"set","key":"probe.lift_mm","value":"8"})", R"({"do":"set","key":3,"value":8})"})
    EXPECT_FALSE(wire::decode(command(text))) << text;
  EXPECT_FALSE(wire::decode(command(R"({"do":"hole","hole":")" + std::string(2000, 'x') + "\"}")));
}

TEST(Wire, noise_is_never_taken_for_a_number_that_is_none) {
  std::mt19937 random(1);
  int taken = 0;
  for (int k = 0; k < 20000; ++k) {
    wire::Bytes bytes(std::uniform_int_distribution<std::size_t>(0, 64)(random));
    for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    const std::uint32_t kind = k % 2 == 0 ? 16 : 17;
    if (bytes.size() >= 4) std::memcpy(bytes.data(), &kind, 4);
    if (k % 4 == 0) bytes.resize(28);  // the length of a hand message
    const auto decoded = wire::decode(bytes);
    if (!decoded) continue;
    ++taken;
    const auto* target = std::get_if<HandTarget>(&*decoded);
    ASSERT_NE(target, nullptr) << "noise is no command";
    ASSERT_TRUE(std::isfinite(target->depth_mm) && std::isfinite(target->roll_deg) && target->speed_mm_per_s >= 0.0);
  }
  EXPECT_GT(taken, 0);
}

TEST(Wire, thinning_keeps_the_largest_and_the_least_force_and_the_order) {
  std::vector<Step> samples(10'000);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].time_s = 1e-3 * static_cast<double>(k);
    samples[k].force_axial_N = std::sin(0.01 * static_cast<double>(k));
  }
  samples[4321].force_axial_N = 9.0;
  samples[8765].force_axial_N = -9.0;
  wire::thin(samples, 500);
  EXPECT_LE(samples.size(), 500u);
  EXPECT_GE(samples.size(), 250u);
  double most = 0.0;
  double least = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    most = std::max(most, samples[k].force_axial_N);
    least = std::min(least, samples[k].force_axial_N);
    if (k > 0) {
      ASSERT_GT(samples[k].time_s, samples[k - 1].time_s);
    }
  }
  EXPECT_EQ(most, 9.0);
  EXPECT_EQ(least, -9.0);
  std::vector<Step> few(3);
  wire::thin(few, 500);
  EXPECT_EQ(few.size(), 3u);
}
