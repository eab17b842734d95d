// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "seed_watch.hpp"
#include "stylet/implant/needle_record.hpp"
#include "stylet/sim/simulation.hpp"

namespace stylet {

/// Keeps the steps of one needle, and its shape at full depth and whenever it leaves a seed.
class NeedleRecorder {
 public:
  /// @param steps expected number of steps
  explicit NeedleRecorder(long steps) { record_.steps.reserve(static_cast<std::size_t>(steps)); }

  /// To be called after each step, and after SeedWatch::add(). @param seconds processor time of the step [s]
  void add(const Simulation& simulation, const SeedWatch& seeds, double seconds);
  /// Keeps the shape of a needle of this simulation, whether the hand holds it or it is at rest.
  /// @param needle its number in the simulation
  void keep_shape(const Simulation& simulation, int needle, std::string when);

  [[nodiscard]] NeedleRecord take() { return std::move(record_); }

 private:
  NeedleRecord record_;
  std::size_t seeds_left_ = 0;
};

}  // namespace stylet
