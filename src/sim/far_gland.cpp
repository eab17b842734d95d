// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/far_gland.hpp"

#include <fmt/format.h>

#include <numbers>

namespace stylet {

namespace {

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

/// The largest turn and the largest shift of a gland without a warning, each with the motion of patients' glands that
/// the warning names. docs/validation.md has the sources.
constexpr double kTurn_deg = 15.0;
constexpr const char* kTurns = "turn (up to about 14°, Lagerburg 2005)";
constexpr double kShift_mm = 21.6;
constexpr const char* kShifts = "move (up to 21.6 mm, Lagerburg 2006)";

}  // namespace

void FarGland::add(const Step& step, const VolumeMotion& motion) {
  const double turn_deg = kDegreesPerRad * motion.rotation_rad.norm();
  const double shift_mm = motion.shift_mm.norm();
  if (turn_deg > turn_deg_.value) turn_deg_ = {turn_deg, step.base_depth_mm};
  if (shift_mm > shift_mm_.value) shift_mm_ = {shift_mm, step.base_depth_mm};
}

std::optional<std::string> FarGland::warning() const {
  std::string text;
  const auto say = [&](const char* what, const Largest& largest, const char* unit, const char* known) {
    text += fmt::format(
        "The gland {} by {:.0f}{} when the needle's base was {:.1f} mm deep, further than glands of "
        "patients are known to {}. ",
        what, largest.value, unit, largest.depth_mm, known);
  };
  if (turn_deg_.value > kTurn_deg) say("turned", turn_deg_, "°", kTurns);
  if (shift_mm_.value > kShift_mm) say("moved", shift_mm_, " mm", kShifts);
  if (text.empty()) return std::nullopt;
  return text +
         "Tissue is computed as if it were strained little, so what the needle meets from there on is doubtful: "
         "enter nearer to the gland's axis, stop earlier, or hold the gland (procedure.stabilising).";
}

}  // namespace stylet
