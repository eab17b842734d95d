// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

#include <optional>
#include <string>

namespace stylet {

/// Follows one insertion and detects a surface (skin or capsule) or tissue that the tip pushes far ahead of itself
/// without breaking or cutting it. Without a warning nobody would notice that the needle does not get behind it.
class UnbrokenSurface {
 public:
  /// [mm] Distance of the tip past the rest position of an unbroken surface, above which there is a warning.
  static constexpr double kFar_mm = 10.0;

  /// Call after each step of the insertion. Allocates.
  void add(const Simulation& simulation);

  /// A warning with distance, force and cure, if the surface in front of the tip has been pressed further than kFar_mm
  /// and has not broken.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  struct Pressed {
    std::string region;
    double past_mm = 0.0;
    double force_N = 0.0;     ///< force of the tip, along the needle
    bool at_surface = true;   ///< false: within the region, whose tissue is not cut
    bool by_cutting = false;  ///< the tissue's cutting force holds the tip, not a membrane
    double needed_N = 0.0;    ///< force that would break the surface or cut the tissue
    std::string owner;        ///< region whose cutting or puncture force this is
  };
  [[nodiscard]] static std::optional<Pressed> pressed_now(const Simulation& simulation);

  std::optional<Pressed> furthest_;  ///< the furthest state of the surface in front of the tip
};

}  // namespace stylet
