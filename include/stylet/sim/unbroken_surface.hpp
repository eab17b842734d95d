// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// Follows one insertion and detects a surface (skin or capsule) or tissue that the tip pushes far ahead of itself
/// without breaking or cutting it, and a needle that bows out instead. Without a warning nobody would notice that the
/// needle does not get behind it. It also detects a surface that was about to break, or broke just before the needle
/// was at its depth: there time step and mesh decide whether the needle gets behind it.
class UnbrokenSurface {
 public:
  /// [mm] Distance of the tip past the rest position of an unbroken surface, above which there is a warning. Tissue
  /// that is not cut holds the tip only if the base has gone that far since the last cut: what was cut before is
  /// dragged along.
  static constexpr double kFar_mm = 10.0;
  /// Distance from base to tip, as a share of the needle's length, below which a needle counts as buckled: it then bows
  /// out by an eighth of its length.
  static constexpr double kBuckled = 0.96;
  /// Part of the force that breaks a surface. A force this near to it counts as a close call.
  static constexpr double kClose = 0.05;

  /// Call after each step of the insertion. Allocates.
  void add(const Simulation& simulation);

  /// A warning with force and cure, if the needle has buckled on the surface in front of its tip, or has pressed it
  /// further than kFar_mm, and the surface has not broken; and one for each close call.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  void forget(double depth_mm);
  struct Pressed {
    std::string region;
    double past_mm = 0.0;     ///< of the tip beyond the rest position of what it presses
    double way_mm = 0.0;      ///< of the base since the tip has cut, or entered the region
    double force_N = 0.0;     ///< force of the tip, along itself
    bool at_surface = true;   ///< false: within the region, whose tissue is not cut
    bool by_cutting = false;  ///< the tissue's cutting force holds the tip, not a membrane
    double needed_N = 0.0;    ///< force that would break the surface or cut the tissue
    std::string owner;        ///< region whose cutting or puncture force this is
    double hand_N = 0.0;      ///< axial force of the hand
    double bow = 1.0;         ///< distance from base to tip over the needle's length
  };
  /// A surface that broke.
  struct Broken {
    std::string region;
    double depth_mm = 0.0;  ///< base depth
    double way_mm = 0.0;    ///< way of the base there, since the force was kClose below the one that breaks
  };
  [[nodiscard]] std::optional<std::string> held() const;
  [[nodiscard]] static std::string text_of(const Pressed& pressed, double most_N);
  [[nodiscard]] std::optional<Pressed> pressed_now(const Simulation& simulation) const;

  std::optional<Pressed> furthest_;    ///< the furthest state of the surface in front of the tip
  std::optional<Pressed> hardest_;     ///< its state with the largest force of the tip
  std::optional<Pressed> buckled_;     ///< the state with the largest force of the hand, of a needle that has buckled
  std::optional<double> slid_off_mm_;  ///< base depth at which the tip of a needle that has buckled slid off
  double easy_mm_ = 0.0;               ///< base depth up to which the surface would have held with kClose less strength
  std::vector<Broken> broken_;
  double deepest_mm_ = 0.0;  ///< largest base depth
  double cut_to_mm_ = 0.0;   ///< base depth at which the tip last cut or entered a region
};

}  // namespace stylet
