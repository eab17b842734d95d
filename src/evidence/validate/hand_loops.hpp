// SPDX-License-Identifier: GPL-3.0-or-later
// Closed loops of the hand with a needle in tissue: what the hand puts in and what it gets back.
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/sim/model.hpp"

#include <array>
#include <memory>
#include <vector>

namespace stylet::validate {

/// A closed way of the needle's base about a pose: push and pull, two ways sideways, two ways of lever, roll. Each is a
/// random sum of three harmonics that begins and ends at zero.
class HandLoop {
 public:
  /// The loop of a number; each number has its own. Loops differ in size by up to 100 times, in depth and in duration.
  explicit HandLoop(unsigned number);

  [[nodiscard]] double depth_mm() const { return depth_mm_; }  ///< of the needle's tip in the tissue where it begins
  [[nodiscard]] double duration_s() const { return duration_s_; }  ///< of one passage
  [[nodiscard]] double size() const { return size_; }  ///< 0.02 … 2; 1: up to some 3 mm, 3° and 90° of roll
  /// @param share of the loop, 0 … 1
  [[nodiscard]] Pose at(const Pose& start, double share) const;

 private:
  static constexpr std::size_t kHarmonics = 3;
  struct Wave {
    double amplitude = 0.0;
    double phase = 0.0;
  };
  double depth_mm_ = 0.0, duration_s_ = 0.0, size_ = 0.0;
  std::array<std::array<Wave, kHarmonics>, 6> waves_{};
};

/// The last of several passages of a loop, all [N mm].
struct HandWork {
  double put_in = 0.0;  ///< work of the hand over the steps in which it works
  double net = 0.0;     ///< over all steps
  double stored = 0.0;  ///< elastic energy of tissue and needle at the end less that at the beginning
  unsigned flags = 0;   ///< Step::flags of all steps, over all passages

  /// What the hand got back beyond what was taken from the store, over what it put in; below 0: energy was lost.
  [[nodiscard]] double given_back() const { return (stored - net) / put_in; }
};

/// Goes in along the first insertion of a model, then passes the loop so many times in so many steps each.
HandWork pass_loop(const std::shared_ptr<const Model>& model, const HandLoop& loop, int passages, int steps);

}  // namespace stylet::validate
