// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/file_kind.hpp"
#include "detail/text.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>

namespace stylet {

namespace {

constexpr std::array<std::string_view, 8> kMotionColumns{"time_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"};
constexpr std::string_view kHeader = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz";
constexpr std::size_t kLongestLine = 1000;

constexpr double kNormTolerance = 1e-3;
// Coordinates beyond this are a mistaken unit; no insertion is that large.
constexpr double kFarthest_mm = 5000.0;
constexpr double kLeastTravel_mm = 1.0;
constexpr double kFastest_mm_per_s = 10e3;
constexpr double kLongest_s = 36e3;

/// Parses one line of numbers.
Result<MotionSample> parse_sample(std::string_view line, const std::string& where) {
  const auto fields = detail::split(line, ',');
  if (fields.size() != kMotionColumns.size()) {
    return input_error(where,
                       fmt::format("the line has {} fields, {} are expected", fields.size(), kMotionColumns.size()),
                       fmt::format("Write {}, separated by commas, decimals with a point", kHeader));
  }
  std::array<double, kMotionColumns.size()> v{};
  for (std::size_t i = 0; i < kMotionColumns.size(); ++i) {
    const auto number = detail::to_number(fields[i]);
    if (!number || !std::isfinite(*number)) {
      return input_error(fmt::format("{}, column {} ({})", where, i + 1, kMotionColumns[i]),
                         fmt::format("'{}' is not a finite number", detail::trimmed(fields[i])),
                         "Write a number with a decimal point, such as 12.5; leave out samples without a reading");
    }
    v[i] = *number;
  }
  MotionSample sample{v[0], {Vec3(v[1], v[2], v[3]), Eigen::Quaterniond(v[4], v[5], v[6], v[7])}};
  if (sample.time_s < 0.0 || sample.time_s > kLongest_s) {
    return input_error(fmt::format("{}, column 1 (time_s)", where),
                       fmt::format("the time {} s is outside 0 … {} s", sample.time_s, kLongest_s),
                       "Count the time from the start of the recording, in seconds");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(sample.base.origin[axis]) <= kFarthest_mm) continue;
    return input_error(
        fmt::format("{}, column {} ({})", where, axis + 2, kMotionColumns[static_cast<std::size_t>(axis) + 1]),
        fmt::format("{} mm lies more than {} mm from the patient's origin", sample.base.origin[axis], kFarthest_mm),
        "Give the base's position in mm in patient coordinates (LPS), not the tracker's");
  }
  const double norm = sample.base.rotation.norm();
  if (std::abs(norm - 1.0) > kNormTolerance) {
    return input_error(fmt::format("{}, columns 5 to 8 (qw, qx, qy, qz)", where),
                       fmt::format("the quaternion's norm is {:.6g}, 1 within {} is expected", norm, kNormTolerance),
                       "Write unit quaternions, the real part qw first");
  }
  sample.base.rotation.normalize();
  return sample;
}

/// Checks two consecutive samples: the time must increase, and the speed must be plausible.
Result<> check_step(const MotionSample& before, const MotionSample& after, const std::string& where) {
  const double step = after.time_s - before.time_s;
  if (!(step > 0.0)) {
    return input_error(fmt::format("{}, column 1 (time_s)", where),
                       fmt::format("the time {} s does not come after {} s", after.time_s, before.time_s),
                       "Sort the samples by time and drop repeated ones");
  }
  const double way = (after.base.origin - before.base.origin).norm();
  if (way > kFastest_mm_per_s * step) {
    return input_error(
        where, fmt::format("the base moves {:.4g} mm in {:.4g} s, faster than {} mm/s", way, step, kFastest_mm_per_s),
        "Check the units (mm and s) and drop false readings");
  }
  return Ok{};
}

Result<> check_header(std::string_view line, const std::string& where) {
  std::string header;
  for (const char c : detail::trimmed(line)) {
    if (c != ' ' && c != '\t') header += c;
  }
  if (header.starts_with("\xEF\xBB\xBF")) header.erase(0, 3);  // byte order mark, which some spreadsheets write
  if (header == kHeader) return Ok{};
  if (header.size() > 100) header = header.substr(0, 100) + "…";
  for (char& c : header) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return input_error(where, fmt::format("the header is '{}'", header), fmt::format("Write the header {}", kHeader));
}

}  // namespace

Result<std::vector<MotionSample>> read_motion_csv(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string how = fmt::format("Name a CSV file with the header {}", kHeader);
  const auto kind = detail::identify(path);
  if (!kind) return input_error(file, kind.error().what, how);
  if (*kind != detail::FileKind::unknown) {
    return input_error(file, fmt::format("this is {}, a recorded motion (CSV) is expected", detail::name_of(*kind)),
                       how);
  }
  std::ifstream stream(path, std::ios::binary);
  std::vector<MotionSample> samples;
  Eigen::AlignedBox3d box;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    const std::string where = fmt::format("{}, line {}", file, number);
    if (line.find('\0') != std::string::npos || line.size() > kLongestLine) {
      return input_error(where, "this is not a line of text", how);
    }
    if (number == 1) {
      if (auto header = check_header(line, where); !header) return header.error();
      continue;
    }
    if (detail::trimmed(line).empty()) continue;
    const auto sample = parse_sample(line, where);
    if (!sample) return sample.error();
    if (!samples.empty()) {
      if (auto step = check_step(samples.back(), *sample, where); !step) return step.error();
    }
    samples.push_back(*sample);
    box.extend(sample->base.origin);
  }
  if (stream.bad()) return input_error(file, "the file cannot be read to its end", "Copy it again");
  if (samples.size() < 2) {
    return input_error(file, fmt::format("there are {} samples, at least 2 are expected", samples.size()),
                       "Record the motion from before the skin to the end");
  }
  if (const double travel = box.diagonal().norm(); travel < kLeastTravel_mm) {
    return input_error(file, fmt::format("the base moves within {:.3g} mm, which is not an insertion", travel),
                       "Give positions in mm: multiply by 1000 if they are in metres");
  }
  return samples;
}

}  // namespace stylet
