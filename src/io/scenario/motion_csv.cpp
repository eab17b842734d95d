// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/csv.hpp"
#include "detail/file_kind.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr std::array<std::string_view, 8> kMotionColumns{"time_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"};
constexpr std::string_view kHeader = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz";
constexpr std::size_t kFirstOfQuaternion = 4;  ///< among kMotionColumns

/// For each of kMotionColumns its column in the file, as the file's header says.
using ColumnOrder = std::array<std::size_t, kMotionColumns.size()>;

constexpr double kNormTolerance = 1e-3;
// Coordinates beyond this are a mistaken unit; no insertion is that large.
constexpr double kFarthest_mm = 5000.0;
constexpr double kLeastTravel_mm = 1.0;
constexpr double kFastest_mm_per_s = 10e3;
constexpr double kLongest_s = 36e3;

/// The names of the quaternion's columns in the order of the file.
std::array<std::string_view, 4> quaternion_of(const ColumnOrder& order) {
  std::array<std::string_view, 4> names{kMotionColumns[4], kMotionColumns[5], kMotionColumns[6], kMotionColumns[7]};
  const auto place = [&](std::string_view name) {
    return order[static_cast<std::size_t>(std::find(kMotionColumns.begin(), kMotionColumns.end(), name) -
                                          kMotionColumns.begin())];
  };
  std::sort(names.begin(), names.end(), [&](auto a, auto b) { return place(a) < place(b); });
  return names;
}

/// The sample of one line.
Result<MotionSample> parse_sample(const std::vector<std::string>& fields, const ColumnOrder& order,
                                  const std::string& where) {
  if (fields.size() != kMotionColumns.size()) {
    return input_error(where,
                       fmt::format("the line has {} fields, {} are expected", fields.size(), kMotionColumns.size()),
                       "Write as many numbers as the header has names, separated by commas, decimals with a point");
  }
  std::array<double, kMotionColumns.size()> v{};
  for (std::size_t i = 0; i < kMotionColumns.size(); ++i) {
    const auto number = detail::csv_number(fields[order[i]]);
    if (!number) {
      return input_error(fmt::format("{}, column {} ({})", where, order[i] + 1, kMotionColumns[i]),
                         fmt::format("'{}' is not a finite number", fields[order[i]]),
                         "Write a number with a decimal point, such as 12.5; leave out samples without a reading");
    }
    v[i] = *number;
  }
  MotionSample sample{v[0], {Vec3(v[1], v[2], v[3]), Eigen::Quaterniond(v[4], v[5], v[6], v[7])}};
  if (sample.time_s < 0.0 || sample.time_s > kLongest_s) {
    return input_error(fmt::format("{}, column {} (time_s)", where, order[0] + 1),
                       fmt::format("the time {} s is outside 0 … {} s", sample.time_s, kLongest_s),
                       "Count the time from the start of the recording, in seconds");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(sample.base.origin[axis]) <= kFarthest_mm) continue;
    return input_error(
        fmt::format("{}, column {} ({})", where, order[static_cast<std::size_t>(axis) + 1] + 1,
                    kMotionColumns[static_cast<std::size_t>(axis) + 1]),
        fmt::format("{} mm lies more than {} mm from the patient's origin", sample.base.origin[axis], kFarthest_mm),
        "Give the base's position in mm in patient coordinates (LPS), not the tracker's");
  }
  const double norm = sample.base.rotation.norm();
  if (std::abs(norm - 1.0) > kNormTolerance) {
    const auto [first, last] = std::minmax_element(order.begin() + kFirstOfQuaternion, order.end());
    return input_error(
        fmt::format("{}, columns {} to {} ({})", where, *first + 1, *last + 1, fmt::join(quaternion_of(order), ", ")),
        fmt::format("the quaternion's norm is {:.6g}, 1 within {} is expected", norm, kNormTolerance),
        "Write unit quaternions, and name their columns qw, qx, qy, qz in the order of the numbers");
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

/// The columns in the order in which the header names them.
Result<ColumnOrder> read_header(const std::vector<std::string>& names, const std::string& where) {
  ColumnOrder order{};
  bool complete = names.size() == kMotionColumns.size();
  for (std::size_t i = 0; i < kMotionColumns.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), kMotionColumns[i]);
    order[i] = static_cast<std::size_t>(found - names.begin());
    complete = complete && found != names.end();
  }
  if (complete) return order;
  std::string header = fmt::format("{}", fmt::join(names, ","));
  if (header.size() > 100) header = header.substr(0, 100) + "…";
  for (char& c : header) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return input_error(where, fmt::format("the header is '{}'", header),
                     fmt::format("Write the header {}, with the names in the order of the columns: w is the "
                                 "quaternion's real part",
                                 kHeader));
}

/// The orientation of a sample if its numbers are in the other order: x y z w where the header says w x y z, or w x y z
/// where it says x y z w.
Eigen::Quaterniond in_other_order(const Eigen::Quaterniond& q, bool real_part_first) {
  return real_part_first ? Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y())
                         : Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w());
}

/// The way in by the orientations, from the first sample to the one that is furthest from it.
struct WayIn {
  double off_axis_deg = 0.0;  ///< angle of the way to the needle's axis, towards the tip; 0 for a needle that is pushed
  double real_part = 0.0;     ///< mean magnitude of the real part; 1: hardly turned, 0: turned by 180°
};

template <class Turn>
WayIn way_in(const std::vector<MotionSample>& samples, const Turn& turn) {
  const auto from_start = [&](const MotionSample& s) { return (s.base.origin - samples.front().base.origin).norm(); };
  const auto end = std::max_element(samples.begin(), samples.end(),
                                    [&](const auto& a, const auto& b) { return from_start(a) < from_start(b); });
  Vec3 axis = Vec3::Zero();
  double real = 0.0;
  for (auto sample = samples.begin(); sample <= end; ++sample) {
    axis += turn(sample->base.rotation) * Vec3::UnitZ();
    real += std::abs(turn(sample->base.rotation).w());
  }
  const Vec3 way = (end->base.origin - samples.front().base.origin).normalized();
  const double along = axis.norm() > 0.0 ? way.dot(axis.normalized()) : 0.0;
  return {std::acos(std::clamp(along, -1.0, 1.0)) * 180.0 / std::numbers::pi,
          real / static_cast<double>(end - samples.begin() + 1)};
}

/// Notices quaternions that only make sense in the other order: a needle is pushed along its axis, and hardly rolled.
/// @param notes gets a sentence where the order is doubtful; may be null
Result<> check_order(const std::vector<MotionSample>& samples, const ColumnOrder& order, const std::string& file,
                     std::vector<std::string>* notes) {
  constexpr double pushed_deg = 20.0;  // no hand pushes a needle further off its axis
  constexpr double astray_deg = 45.0;
  constexpr double noticed_deg = 3.0;
  const bool real_part_first = order[kFirstOfQuaternion] < order[kFirstOfQuaternion + 1];
  const WayIn stated = way_in(samples, [](const auto& q) { return q; });
  const WayIn other = way_in(samples, [&](const auto& q) { return in_other_order(q, real_part_first); });
  const std::string place = fmt::format("{}, columns {}", file, fmt::join(quaternion_of(order), ", "));
  const std::string cure = fmt::format("Name the columns in the order of the numbers: {}",
                                       real_part_first ? "time_s,x_mm,y_mm,z_mm,qx,qy,qz,qw" : kHeader);
  const char* in_other = real_part_first ? "x y z w" : "w x y z";
  if (stated.off_axis_deg > astray_deg && other.off_axis_deg < pushed_deg) {
    return input_error(place,
                       fmt::format("by these quaternions the needle moves {:.0f}° away from its own axis; taken as {} "
                                   "it moves along it, so the numbers are probably in this order",
                                   stated.off_axis_deg, in_other),
                       cure);
  }
  const bool better = stated.off_axis_deg > noticed_deg && other.off_axis_deg < stated.off_axis_deg / 3.0;
  const bool half_turn = stated.real_part < 0.3 && other.real_part > 0.95 &&  // sin 17°, cos 18°
                         other.off_axis_deg < stated.off_axis_deg + 1.0;
  if (notes && (better || half_turn)) {
    notes->push_back(fmt::format(
        "{}: the quaternions may be in the order {}: taken so, the needle moves {:.1f}° off its axis and is {}, and as "
        "the header says {:.1f}° and {}. {} if this is so.",
        place, in_other, other.off_axis_deg, other.real_part > 0.95 ? "hardly turned" : "turned", stated.off_axis_deg,
        stated.real_part < 0.3 ? "turned by half a turn" : "turned", cure));
  }
  return Ok{};
}

}  // namespace

Result<std::vector<MotionSample>> read_motion_csv(const std::filesystem::path& path, std::vector<std::string>* notes) {
  const std::string file = path.string();
  const std::string how = fmt::format("Name a CSV file with the header {}", kHeader);
  const auto kind = detail::identify(path);
  if (!kind) return input_error(file, kind.error().what, how);
  if (*kind != detail::FileKind::unknown) {
    return input_error(file, fmt::format("this is {}, a recorded motion (CSV) is expected", detail::name_of(*kind)),
                       how);
  }
  const auto csv = detail::read_csv_lines(path);
  if (!csv) return csv.error();
  std::vector<MotionSample> samples;
  ColumnOrder order{};
  Eigen::AlignedBox3d box;
  for (const auto& [number, fields] : csv->lines) {
    const std::string where = fmt::format("{}, line {}", file, number);
    if (&fields == &csv->lines.front().fields) {
      const auto header = read_header(fields, where);
      if (!header) return header.error();
      order = *header;
      continue;
    }
    const auto sample = parse_sample(fields, order, where);
    if (!sample) return sample.error();
    if (!samples.empty()) {
      if (auto step = check_step(samples.back(), *sample, where); !step) return step.error();
    }
    samples.push_back(*sample);
    box.extend(sample->base.origin);
  }
  if (samples.size() < 2) {
    return input_error(file, fmt::format("there are {} samples, at least 2 are expected", samples.size()),
                       "Record the motion from before the skin to the end");
  }
  if (const double travel = box.diagonal().norm(); travel < kLeastTravel_mm) {
    return input_error(file, fmt::format("the base moves within {:.3g} mm, which is not an insertion", travel),
                       "Give positions in mm: multiply by 1000 if they are in metres");
  }
  if (Result<> sense = check_order(samples, order, file, notes); !sense) return sense.error();
  return samples;
}

}  // namespace stylet
