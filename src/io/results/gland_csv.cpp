// SPDX-License-Identifier: GPL-3.0-or-later
#include "gland_csv.hpp"

#include "fixed_number.hpp"

namespace stylet::results {

namespace {

constexpr int kPathTimeDigits = 6;  // s: a microsecond
constexpr int kShiftDigits = 6;     // mm: a nanometre
constexpr int kTurnDigits = 6;      // degrees: less than a nanometre at the rim of a gland of 60 mm

}  // namespace

std::string gland_csv(std::span<const GlandStep> path) {
  std::string text =
      "time_s,base_depth_mm,shift_LR_mm,shift_AP_mm,shift_SI_mm,rotation_coronal_deg,rotation_sagittal_deg,"
      "rotation_transverse_deg\n";
  text.reserve(text.size() + path.size() * 80);
  for (const GlandStep& step : path) {
    text += fixed(step.time_s, kPathTimeDigits) + "," + fixed(step.base_depth_mm, kShiftDigits);
    for (const double shift : step.shift_mm) text += "," + fixed(shift, kShiftDigits);
    const PlaneAngles angles = plane_angles(step.rotation_deg);
    for (const double angle : {angles.coronal, angles.sagittal, angles.transverse})
      text += "," + fixed(angle, kTurnDigits);
    text += '\n';
  }
  return text;
}

}  // namespace stylet::results
