// SPDX-License-Identifier: GPL-3.0-or-later
// Closed loops of the hand with a needle in tissue. They measure the work that the hand does and the work that it gets
// back, which must not be larger (passivity).
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/coupling/step.hpp"
#include "stylet/sim/model.hpp"

#include <array>
#include <memory>
#include <vector>

namespace stylet::validate {

/// [N mm] Work of the hand between two steps, with the mean of force and torque, which is accurate to second order.
double work_of_hand(const Step& before, const Step& after);

/// A closed motion of the needle's base about a pose in six directions: push and pull, two sideways translations, two
/// tilts, and roll. Each is a random sum of three harmonics that begins and ends at zero.
class HandLoop {
 public:
  /// @param number seed: each number gives another loop. Loops differ in size (by up to 100 times), depth and duration.
  explicit HandLoop(unsigned number);

  [[nodiscard]] double depth_mm() const { return depth_mm_; }      ///< depth of the tip at the start of the loop
  [[nodiscard]] double duration_s() const { return duration_s_; }  ///< duration of one passage
  [[nodiscard]] double size() const { return size_; }  ///< 0.02 … 2; 1 stands for up to about 3 mm, 3° and 90° of roll
  /// Pose of the base. @param share part of the loop that has passed, 0 … 1
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

/// Work in the last of several passages of a loop [N mm].
struct HandWork {
  double put_in = 0.0;  ///< work of the hand over the steps in which it is positive
  double net = 0.0;     ///< work of the hand over all steps
  double stored = 0.0;  ///< increase of the elastic energy of tissue and needle
  unsigned flags = 0;   ///< Step::flags of all steps of all passages

  /// (stored − net) / put_in: the energy that the hand and the stored energy gained, relative to the work of the hand.
  /// Negative if energy was lost.
  [[nodiscard]] double given_back() const { return (stored - net) / put_in; }
};

/// Inserts a needle along the first insertion of a model, then passes the loop `passages` times in `steps` steps each.
HandWork pass_loop(const std::shared_ptr<const Model>& model, const HandLoop& loop, int passages, int steps);

}  // namespace stylet::validate
