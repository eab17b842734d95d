// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/sim/choices.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// A seed in a needle.
struct LoadedSeed {
  std::size_t number = 0;          ///< its position in DosePlan::sources
  Vec3 planned_mm = Vec3::Zero();  ///< [mm] LPS, planned place of its centre
  Vec3 axis = Vec3::UnitZ();       ///< planned axis, towards the needle's tip
  double behind_tip_mm = 0.0;      ///< [mm] from the needle's tip to its centre while the needle is at its depth
};

/// A needle with its train of seeds, or a catheter with its dwell positions.
struct NeedleLoad {
  Implant implant = Implant::permanent;  ///< temporary: a catheter, which stays until the dose has been delivered
  std::string name;                      ///< hole of the template, name of the channel, or "needle 3"
  Vec3 tip_mm = Vec3::Zero();            ///< [mm] LPS, place of the tip while the needle is at its depth
  Vec3 direction = Vec3::UnitZ();        ///< unit vector LPS, towards the tip
  std::vector<LoadedSeed> seeds;         ///< from the tip on
  Vec3 aim_mm = Vec3::Zero();            ///< [mm] LPS, by which tip and seeds are aimed beside their plan on purpose
  std::optional<bool> stranded;          ///< whether its seeds are a strand; unset: Scenario::Seed::stranded
  double beside_line_mm = 0.0;           ///< largest distance of a planned seed from the needle's line
};

/// The needles of a plan of seeds, in the order of the plan. Seeds with the same name of needle are in one needle;
/// seeds without a name are in one needle if they lie on one line along their axes. The line of a needle is the
/// straight line that fits its seeds best; its direction is from inferior to superior.
/// @param seed_length_mm length of the capsule @param plug_mm length of the plug between the tip and the first seed
/// Errors: no seeds; a temporary implant; seeds of one needle that lie further than 5 mm beside a straight line, or
/// nearer to each other along it than half a seed.
Result<std::vector<NeedleLoad>> load_needles(const DosePlan& plan, double seed_length_mm, double plug_mm);

/// The catheters of a temporary implant, found as load_needles() finds needles; each channel is a catheter. Dwell
/// positions without a dwell time are kept: they move as the others and give no dose.
/// @param tip_mm distance from a catheter's tip to the centre of its most distal dwell position
/// Errors: no dwell position with a time; a permanent implant; dwell positions of one catheter that lie further than 5
/// mm beside a straight line.
Result<std::vector<NeedleLoad>> load_catheters(const DosePlan& plan, double tip_mm);

/// Aims a needle further beside its plan: its line and its retraction plane move by `shift` [mm] LPS.
void aim(NeedleLoad& needle, const Vec3& shift);

/// Sorts needles as a procedure wants them.
void order_needles(std::vector<NeedleLoad>& needles, NeedleOrder order);

}  // namespace stylet
