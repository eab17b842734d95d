// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/gland_watch.hpp"
#include "stylet/sim/staying_needles.hpp"
#include "stylet/sim/target_motion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// Watches an insertion beside needles in place, and counts from the tissue as they hold it.
class BesideNeedles {
 public:
  /// Looks at the tissue before the insertion, with its needle in the air. @param gland null without a target
  /// @param targets names of the regions that form the gland
  /// @param deepest pose of the base at its deepest @param remarks of put_in_staying_needles()
  BesideNeedles(Simulation& simulation, TargetMotion* gland, std::vector<std::string> targets, const Pose& deepest,
                std::vector<std::string> remarks);

  /// Adds a step, as GlandWatch::add(). Only with a target.
  void add(const Step& step, std::span<const Event> events, VolumeMotion motion, bool at_rest, bool deepest);

  /// The figures so far. @param tip_error_mm Summary::tip_error_mm of the insertion
  [[nodiscard]] NeedlesInPlace result(const std::optional<Vec3>& tip_error_mm) const;

 private:
  NeedlesInPlace before_;              ///< holes, remarks, and shift of the gland
  std::optional<GlandWatch> further_;  ///< of the gland's motion less shift_mm
  std::optional<Vec3> moved_mm_;       ///< displacement of the material that is where the tip is aimed at
};

}  // namespace stylet
