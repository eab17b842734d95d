// SPDX-License-Identifier: GPL-3.0-or-later
#include "support.hpp"

#include <cmath>
#include <sstream>

using namespace stylet;
using namespace stylet::test;

namespace {

const std::string kHeader = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";

Result<std::vector<MotionSample>> read_motion(const std::string& content) {
  const Folder folder;
  return read_motion_csv(write_file(folder / "hand.csv", content));
}

/// The message of the error for a motion with this line as its second sample.
std::string refused_sample(const std::string& line) {
  const std::string message = refusal(read_motion(kHeader + "0,0,0,-250,1,0,0,0\n" + line + "\n"));
  expect_says(message, {"hand.csv, line 3"});
  return message;
}

}  // namespace

TEST(MotionCsv, is_read_as_it_stands) {
  const auto samples = value_of(read_motion(
      kHeader + "0,1.5,-2,-250,1,0,0,0\n0.5, 1.5, -2, -240.25, 0, 0, 1, 0\n1e0,1.5,-2,-200,0.6,0,0,-0.8\n"));
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[0].time_s, 0.0);
  EXPECT_EQ(samples[0].base.origin, Vec3(1.5, -2, -250));
  EXPECT_EQ(samples[1].time_s, 0.5);
  EXPECT_EQ(samples[1].base.origin, Vec3(1.5, -2, -240.25));
  EXPECT_EQ(samples[1].base.rotation.y(), 1.0);
  EXPECT_EQ(samples[2].time_s, 1.0);
  EXPECT_NEAR(samples[2].base.rotation.w(), 0.6, 1e-15);
  EXPECT_NEAR(samples[2].base.rotation.z(), -0.8, 1e-15);
}

TEST(MotionCsv, takes_line_ends_spaces_and_marks_of_other_programs) {
  const auto samples = value_of(read_motion(
      "\xEF\xBB\xBFtime_s, x_mm, y_mm, z_mm, qw, qx, qy, qz\r\n0,0,0,-250,1,0,0,0\r\n\r\n1,0,0,-200,1,0,0,0\r\n\r\n"));
  EXPECT_EQ(samples.size(), 2U);
}

TEST(MotionCsv, quaternions_come_out_with_norm_one) {
  const auto samples = value_of(read_motion(kHeader + "0,0,0,-250,1.0009,0,0,0\n1,0,0,-200,0.7071,0.7071,0,0\n"));
  for (const MotionSample& sample : samples) EXPECT_NEAR(sample.base.rotation.norm(), 1.0, 1e-15);
}

TEST(MotionCsv, a_motion_written_with_full_precision_is_read_to_the_last_bit) {
  const BaseMotion motion =
      BaseMotion::straight({1, 2, -40}, Vec3(0.1, 0.2, 1).normalized(), 200, 3, 60, 20, 0.3, true, 10);
  std::ostringstream out;
  out.precision(17);
  out << kHeader;
  for (const MotionSample& s : motion.samples()) {
    out << s.time_s << ',' << s.base.origin.x() << ',' << s.base.origin.y() << ',' << s.base.origin.z() << ','
        << s.base.rotation.w() << ',' << s.base.rotation.x() << ',' << s.base.rotation.y() << ',' << s.base.rotation.z()
        << '\n';
  }
  const auto samples = value_of(read_motion(out.str()));
  ASSERT_EQ(samples.size(), motion.samples().size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].time_s, motion.samples()[i].time_s);
    EXPECT_EQ(samples[i].base.origin, motion.samples()[i].base.origin);
    EXPECT_LT(samples[i].base.rotation.angularDistance(motion.samples()[i].base.rotation), 1e-7);
  }
}

TEST(MotionCsv, what_is_no_motion_is_refused) {
  const Folder folder;
  expect_says(refusal(read_motion_csv(folder / "no.csv")), {"no.csv", "no such file", "time_s,x_mm"});
  expect_says(refusal(read_motion_csv(folder.path())), {"a folder"});
  expect_says(refusal(read_motion_csv(write_file(folder / "e.csv", ""))), {"e.csv", "empty"});
  expect_says(refusal(read_motion_csv(write_file(folder / "m.csv", "NRRD0004\n"))),
              {"m.csv: this is an NRRD image", "CSV"});
  expect_says(refusal(read_motion_csv(write_file(folder / "b.csv", std::string("time\0", 5)))),
              {"b.csv, line 1", "not a line of text"});
  expect_says(refusal(read_motion_csv(write_file(folder / "l.csv", std::string(5000, 'x')))), {"l.csv, line 1"});
}

TEST(MotionCsv, another_header_is_refused_with_the_right_one) {
  const std::string message = refusal(read_motion("time,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n"));
  expect_says(message, {"hand.csv, line 1", "'time,x,y,z,qx,qy,qz,qw'",
                        "Write the header time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz", "real part"});
  expect_says(refusal(read_motion("0,0,0,-250,1,0,0,0\n1,0,0,-200,1,0,0,0\n")),
              {"line 1", "the header is '0,0,0,-250"});
}

TEST(MotionCsv, too_few_samples_are_refused) {
  expect_says(refusal(read_motion(kHeader)), {"hand.csv", "0 samples", "at least 2"});
  expect_says(refusal(read_motion(kHeader + "0,0,0,-250,1,0,0,0\n")), {"1 samples"});
}

TEST(MotionCsv, fields_that_are_missing_or_no_numbers_are_refused_with_line_and_column) {
  expect_says(refused_sample("1,0,0,-200,1,0,0"), {"7 fields, 8 are expected"});
  expect_says(refused_sample("1,0,0,-200,1,0,0,0,"), {"9 fields"});
  expect_says(refused_sample("1;0;0;-200;1;0;0;0"), {"1 fields", "separated by commas"});
  expect_says(refused_sample("1,0,zero,-200,1,0,0,0"), {"column 3 (y_mm)", "'zero'"});
  expect_says(refused_sample("1,,0,-200,1,0,0,0"), {"column 2 (x_mm)", "''"});
  expect_says(refused_sample("1,0,0,nan,1,0,0,0"),
              {"column 4 (z_mm)", "'nan' is not a finite number", "without a reading"});
  expect_says(refused_sample("inf,0,0,-200,1,0,0,0"), {"column 1 (time_s)", "'inf'"});
  expect_says(refused_sample("1,0,0,-200mm,1,0,0,0"), {"column 4 (z_mm)", "'-200mm'"});
  expect_says(refused_sample("1,0,0,1e999,1,0,0,0"), {"column 4 (z_mm)", "'1e999'"});
}

TEST(MotionCsv, times_must_increase_from_zero_on) {
  expect_says(refused_sample("0,0,0,-200,1,0,0,0"), {"column 1 (time_s)", "0 s does not come after 0 s", "Sort"});
  expect_says(refused_sample("-1,0,0,-200,1,0,0,0"), {"column 1 (time_s)", "-1 s is outside 0 … 36000 s"});
  expect_says(refused_sample("1666000000.5,0,0,-200,1,0,0,0"),
              {"1666000000.5 s is outside", "from the start of the recording"});
}

TEST(MotionCsv, rotations_must_be_unit_quaternions) {
  expect_says(refused_sample("1,0,0,-200,0,0,0,0"),
              {"columns 5 to 8 (qw, qx, qy, qz)", "norm is 0", "Write unit quaternions"});
  expect_says(refused_sample("1,0,0,-200,1.0011,0,0,0"), {"norm is 1.0011", "0.001"});
  expect_says(refused_sample("1,0,0,-200,1,1,0,0"), {"norm is 1.41421"});
}

TEST(MotionCsv, positions_in_other_units_are_refused) {
  expect_says(refused_sample("100,0,0,-250000,1,0,0,0"), {"column 4 (z_mm)", "-250000 mm lies more than 5000 mm"});
  expect_says(refusal(read_motion(kHeader + "0,0,0,-0.25,1,0,0,0\n1,0,0,-0.20,1,0,0,0\n")),
              {"hand.csv", "moves within 0.05 mm", "multiply by 1000"});
  expect_says(refused_sample("1e-3,0,0,-200,1,0,0,0"),
              {"moves 50 mm in 0.001 s, faster than 10000 mm/s", "Check the units"});
}

TEST(MotionCsv, the_header_says_the_order_of_the_columns) {
  const auto samples =
      value_of(read_motion("qx,qy,qz,qw,time_s,x_mm,y_mm,z_mm\n0,0,0,1,0,0,0,-250\n0,0,0.6,0.8,1,3,2,-200\n"));
  EXPECT_EQ(samples[1].time_s, 1.0);
  EXPECT_EQ(samples[1].base.origin, Vec3(3, 2, -200));
  EXPECT_NEAR(samples[1].base.rotation.w(), 0.8, 1e-15);
  EXPECT_NEAR(samples[1].base.rotation.z(), 0.6, 1e-15);
  expect_says(refusal(read_motion("qx,qy,qz,qw,time_s,x_mm,y_mm,z_mm\n0,0,0,1,0,0,0,-250\n0,0,0,2,1,3,2,-200\n")),
              {"line 3, columns 1 to 4 (qx, qy, qz, qw)", "norm is 2"});
}

namespace {

/// A needle pushed along its axis, with the columns of the quaternion in this order.
std::string pushed_along(const Vec3& direction, bool header_real_first, bool numbers_real_first,
                         double roll_rad = 0.0) {
  const BaseMotion motion = BaseMotion::straight({1, 2, -40}, direction, 200, 3, 60, 20, 0.3, true, 10, roll_rad);
  std::ostringstream out;
  out.precision(12);
  out << (header_real_first ? kHeader : "time_s,x_mm,y_mm,z_mm,qx,qy,qz,qw\n");
  for (const MotionSample& s : motion.samples()) {
    const Eigen::Quaterniond& q = s.base.rotation;
    out << s.time_s << ',' << s.base.origin.x() << ',' << s.base.origin.y() << ',' << s.base.origin.z() << ',';
    if (numbers_real_first) out << q.w() << ',';
    out << q.x() << ',' << q.y() << ',' << q.z();
    if (!numbers_real_first) out << ',' << q.w();
    out << '\n';
  }
  return out.str();
}

}  // namespace

TEST(MotionCsv, quaternions_in_the_other_order_than_the_header_says_are_noticed) {
  const auto noticed = [](const std::string& content) {
    const Folder folder;
    std::vector<std::string> notes;
    const auto samples = read_motion_csv(write_file(folder / "hand.csv", content), &notes);
    return samples.ok() ? (notes.empty() ? std::string() : notes.front()) : samples.error().message();
  };
  for (const Vec3& way : {Vec3(0, 0, 1), Vec3(0.1, 0.2, 1), Vec3(-0.2, 0.1, 1), Vec3(1, 0.3, 0.2)}) {
    for (const double roll : {0.0, 0.7}) {
      const Vec3 d = way.normalized();
      EXPECT_EQ(noticed(pushed_along(d, true, true, roll)), "");
      EXPECT_EQ(noticed(pushed_along(d, false, false, roll)), "");
      const std::string not_wxyz = noticed(pushed_along(d, true, false, roll));
      expect_says(not_wxyz, {"x y z w", "Name the columns in the order of the numbers", "z_mm,qx,qy,qz,qw"});
      const std::string not_xyzw = noticed(pushed_along(d, false, true, roll));
      expect_says(not_xyzw, {"w x y z", "z_mm,qw,qx,qy,qz"});
    }
  }
}

TEST(MotionCsv, quaternions_by_which_the_needle_would_go_sideways_are_refused) {
  const std::string message = refusal(read_motion(pushed_along(Vec3::UnitZ(), false, true)));
  expect_says(message, {"hand.csv, columns qx, qy, qz, qw", "moves 180° away from its own axis", "w x y z"});
}
