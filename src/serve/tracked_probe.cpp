// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracked_probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace stylet::serve {

namespace {

constexpr std::array kStepperKeys{"probe.depth_mm", "probe.lift_mm", "probe.tilt_deg", "probe.roll_deg"};
// Deviations up to the former are calibration errors of a tracker, and up to the latter the rectum is still there.
constexpr double kUnsaid_mm = 1.0, kUnsaid_deg = 1.0;
constexpr double kFollowed_mm = 10.0, kFollowed_deg = 10.0;

const char* side(double positive_is_left) { return positive_is_left > 0.0 ? "left" : "right"; }

std::string deviation_of(const StepperMotions& motions) {
  std::string text;
  if (std::abs(motions.aside_mm) > kUnsaid_mm)
    text = fmt::format("{:.0f} mm to the patient's {} of the rectum's middle", std::abs(motions.aside_mm),
                       side(motions.aside_mm));
  if (std::abs(motions.turned_deg) > kUnsaid_deg)
    text += fmt::format("{}turned by {:.0f}° to the {}", text.empty() ? "" : " and ", std::abs(motions.turned_deg),
                        side(motions.turned_deg));
  return text;
}

}  // namespace

bool is_of_stepper(std::string_view key) {
  return std::find(kStepperKeys.begin(), kStepperKeys.end(), key) != kStepperKeys.end();
}

std::string follow(const Pose& pose, const ProbeSeat& seat, Scenario& tables) {
  const StepperMotions motions = stepper_motions(pose, seat);
  const std::string deviation = deviation_of(motions);
  if (std::abs(motions.aside_mm) > kFollowed_mm || std::abs(motions.turned_deg) > kFollowed_deg)
    return "The probe does not follow: its tracked pose is " + deviation + ". Move it back to the rectum.";
  Scenario moved = tables;
  const std::array values{motions.depth_mm, motions.lift_mm, motions.tilt_deg, motions.roll_deg};
  for (std::size_t k = 0; k < values.size(); ++k) {
    const ScenarioValue as_number{.type = ScenarioValue::Type::number, .number = values[k]};
    if (auto done = set_scenario_key(moved, kStepperKeys[k], as_number, kStepperKeys[k]); !done)
      return fmt::format("The probe does not follow its tracked pose: {}, {}. {}.", done.error().where,
                         done.error().what, done.error().cure);
  }
  tables.probe = moved.probe;
  if (deviation.empty()) return {};
  return "The tracked probe is " + deviation + "; a stepper cannot do this, so the probe here stays in the middle.";
}

}  // namespace stylet::serve
