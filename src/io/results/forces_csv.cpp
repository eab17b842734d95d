// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces_csv.hpp"

#include "fixed_number.hpp"

#include <fmt/format.h>

#include <iterator>

namespace stylet::results {

namespace {

void append(std::string& text, double value, int digits) { text += fixed(value, digits) + ','; }

constexpr int kLengthDigits = 6;  // mm: a nanometre
constexpr int kTimeDigits = 6;    // s: a microsecond
constexpr int kForceDigits = 9;   // N, N mm: nine digits below the newton show balances and drifts
constexpr int kStepDigits = 1;    // µs

}  // namespace

std::string_view forces_csv_header() {
  return "time_s,base_depth_mm,force_axial_N,force_sagittal_N,force_lateral_N,torque_x_Nmm,torque_y_Nmm,torque_z_Nmm,"
         "tip_x_mm,tip_y_mm,tip_z_mm,tip_state,contacts,sticking,iterations,step_us";
}

std::string forces_csv(std::span<const Step> steps) {
  std::string text(forces_csv_header());
  text += '\n';
  text.reserve(text.size() + steps.size() * 180);
  for (const Step& step : steps) {
    append(text, step.time_s, kTimeDigits);
    append(text, step.base_depth_mm, kLengthDigits);
    append(text, step.force_axial_N, kForceDigits);
    append(text, step.force_sagittal_N, kForceDigits);
    append(text, step.force_lateral_N, kForceDigits);
    for (int k = 0; k < 3; ++k) append(text, step.torque_Nmm[k], kForceDigits);
    for (int k = 0; k < 3; ++k) append(text, step.tip_mm[k], kLengthDigits);
    fmt::format_to(std::back_inserter(text), "{},{},{},{},", to_string(step.tip_state), step.contacts, step.sticking,
                   step.iterations);
    append(text, step.step_us, kStepDigits);
    text.back() = '\n';
  }
  return text;
}

}  // namespace stylet::results
