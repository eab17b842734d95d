// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

#include <optional>
#include <string>

namespace stylet {

/// Watches one insertion for a surface (skin or capsule) that the tip presses far in front of it and that never breaks:
/// such a needle goes on without a word, and everything behind that surface is missed.
class UnbrokenSurface {
 public:
  /// A tip this far past where an unbroken surface lies at rest is worth a warning [mm].
  static constexpr double kFar_mm = 10.0;

  /// After each step of the insertion. Allocates.
  void add(const Simulation& simulation);

  /// A sentence with distance, force and cure, where a surface was still unbroken at the end.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  struct Pressed {
    std::string region;
    double past_mm = 0.0;
    double force_N = 0.0;   ///< of the tip, along the needle
    double breaks_N = 0.0;  ///< what would break it
  };
  [[nodiscard]] static std::optional<Pressed> pressed_now(const Simulation& simulation);

  std::optional<Pressed> furthest_;  ///< of the surface ahead
};

}  // namespace stylet
