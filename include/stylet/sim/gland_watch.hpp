// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/volume_motion.hpp"
#include "stylet/sim/recording.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// Picks from the gland's motion, step by step, what is told of an insertion.
class GlandWatch {
 public:
  /// @param targets names of the regions that form the gland
  explicit GlandWatch(std::vector<std::string> targets) : targets_(std::move(targets)) {}

  /// A step has been taken.
  /// @param motion of the gland after it @param at_rest whether nothing acts on the tissue any more
  /// @param deepest whether the base goes no further in after it
  GlandStep add(const Step& step, std::span<const Event> events, const VolumeMotion& motion, bool at_rest,
                bool deepest);

  /// The gland's motion over the steps that were added so far.
  [[nodiscard]] GlandMotion result() const;

 private:
  void notice(const Event& event);
  [[nodiscard]] bool is_target(const std::string& region) const;

  std::vector<std::string> targets_;
  GlandMotion motion_;
  Vec3 last_shift_mm_ = Vec3::Zero();
  bool advancing_ = true;              ///< up to the deepest step
  bool at_rest_ = false;               ///< after the last step
  std::optional<double> withdrawn_s_;  ///< when the needle came out
};

}  // namespace stylet
