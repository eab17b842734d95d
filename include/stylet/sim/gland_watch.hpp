// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/volume_motion.hpp"
#include "stylet/sim/recording.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// Follows the gland's motion step by step and collects the figures that are reported about an insertion.
class GlandWatch {
 public:
  /// @param targets names of the regions that form the gland
  explicit GlandWatch(std::vector<std::string> targets) : targets_(std::move(targets)) {}

  /// Adds a step that has been taken.
  /// @param motion of the gland after the step @param at_rest whether no force acts on the tissue after the step
  /// @param deepest whether this is the last step of the way in: the base goes no deeper afterwards
  GlandStep add(const Step& step, std::span<const Event> events, const VolumeMotion& motion, bool at_rest,
                bool deepest);

  /// The gland's motion over all steps that have been added.
  [[nodiscard]] GlandMotion result() const;

 private:
  void notice(const Event& event);
  [[nodiscard]] bool is_target(const std::string& region) const;

  std::vector<std::string> targets_;
  GlandMotion motion_;
  Vec3 last_shift_mm_ = Vec3::Zero();
  bool advancing_ = true;              ///< the deepest step has not been added
  bool at_rest_ = false;               ///< no force acted on the tissue after the last step
  std::optional<double> withdrawn_s_;  ///< time at which the needle came out
};

}  // namespace stylet
