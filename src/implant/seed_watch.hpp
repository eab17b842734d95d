// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle_motion.hpp"
#include "stylet/implant/seed_history.hpp"
#include "stylet/sim/simulation.hpp"

namespace stylet {

/// Follows the seeds of one needle through its simulation. To be called after each step.
class SeedWatch {
 public:
  /// All arguments outlive the watch.
  SeedWatch(const NeedleLoad& load, const NeedleMotion& motion, const Scenario& scenario, double seed_length_mm);

  void add(Simulation& simulation, double since_start_s);

  /// Numbers in the plan of the seeds that have been left so far, in this order.
  [[nodiscard]] const std::vector<std::size_t>& left() const { return left_; }

  /// The seeds in the order of the load. Seeds that have not been left count as dropped where they are in the needle.
  [[nodiscard]] std::vector<SeedHistory> result() const;

 private:
  /// A seed on its way out of the needle.
  struct Seed {
    SeedHistory history;
    bool is_placed = false;  ///< its place in the room is known
    Vec3 axis = Vec3::UnitZ();
    bool is_left = false;
  };
  void place(Seed& seed, const Needle& needle, double arc_mm);
  void leave(Seed& seed, Simulation& simulation, double since_start_s);

  const NeedleLoad& load_;
  const NeedleMotion& motion_;
  SeedTechnique technique_;
  double seed_length_mm_;
  std::vector<Seed> seeds_;
  std::vector<std::size_t> left_;
};

}  // namespace stylet
