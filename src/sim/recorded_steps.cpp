// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/recorded_steps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stylet {

namespace {

std::int64_t nanoseconds(double time_s) { return std::llround(time_s * 1e9); }

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool same_bits(const Pose& a, const Pose& b) {
  bool same = true;
  for (Eigen::Index k = 0; k < 3; ++k) same = same && same_bits(a.origin[k], b.origin[k]);
  for (Eigen::Index k = 0; k < 4; ++k) same = same && same_bits(a.rotation.coeffs()[k], b.rotation.coeffs()[k]);
  return same;
}

Vec3 force(const Step& s) { return {s.force_axial_N, s.force_sagittal_N, s.force_lateral_N}; }

/// The step at rest that is `number` ≥ 1 steps after a record.
Step at_rest(const Step& record, std::int64_t number) {
  Step step = record;
  step.rest_steps = 0;
  // Simulation counts time in whole nanoseconds; the same arithmetic gives the same bits.
  step.time_s = static_cast<double>(nanoseconds(record.time_s) + number * nanoseconds(record.dt_s)) / 1e9;
  return step;
}

}  // namespace

bool is_at_rest(const Step& earlier, const Step& step) {
  return same_bits(earlier.dt_s, step.dt_s) && same_bits(earlier.base, step.base) &&
         earlier.tip_state == step.tip_state && earlier.contacts == step.contacts &&
         earlier.sticking == step.sticking && earlier.flags == step.flags &&
         (force(earlier) - force(step)).norm() <= kRestForce_N &&
         (earlier.torque_Nmm - step.torque_Nmm).norm() <= kRestTorque_Nmm &&
         (earlier.tip_mm - step.tip_mm).norm() <= kRestPlace_mm;
}

RecordedSteps::RecordedSteps(std::span<const Step> records) : records_(records) {
  ends_.reserve(records.size());
  for (const Step& record : records) ends_.push_back(count() + record.rest_steps + 1);
}

Step RecordedSteps::at(std::int64_t step) const {
  const auto end = std::upper_bound(ends_.begin(), ends_.end(), step);
  const Step& record = records_[static_cast<std::size_t>(end - ends_.begin())];
  const std::int64_t left = *end - 1 - step;
  if (left > 0) return at_rest(*(&record - 1), record.rest_steps + 1 - left);
  Step itself = record;
  itself.rest_steps = 0;
  return itself;
}

bool RecordedSteps::is_recorded(std::int64_t step) const {
  return std::binary_search(ends_.begin(), ends_.end(), step + 1);
}

std::int64_t RecordedSteps::last_at(double time_s) const {
  const auto after = std::upper_bound(records_.begin(), records_.end(), time_s,
                                      [](double t, const Step& record) { return t < record.time_s; });
  if (after == records_.begin()) return -1;
  const auto before = static_cast<std::size_t>(after - records_.begin()) - 1;
  std::int64_t step = ends_[before] - 1;
  if (after == records_.end() || after->rest_steps == 0) return step;
  const Step& record = records_[before];
  const std::int64_t dt_ns = std::max<std::int64_t>(nanoseconds(record.dt_s), 1);
  return step +
         std::clamp<std::int64_t>((nanoseconds(time_s) - nanoseconds(record.time_s)) / dt_ns, 0, after->rest_steps);
}

std::vector<Step> with_ends_of_rests(std::span<const Step> records) {
  std::vector<Step> steps;
  steps.reserve(records.size());
  for (const Step& record : records) {
    if (record.rest_steps > 0 && !steps.empty()) steps.push_back(at_rest(steps.back(), record.rest_steps));
    steps.push_back(record);
    steps.back().rest_steps = 0;
  }
  return steps;
}

}  // namespace stylet
