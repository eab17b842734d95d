// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/latest_value.hpp"
#include "stylet/realtime/wrench.hpp"
#include "stylet/sim/material_search.hpp"
#include "stylet/sim/simulation.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace stylet {

/// A seed that the needle left while the loop ran. All places are of its centre, in LPS [mm].
struct ProbedDrop {
  bool is_done = false;        ///< the other fields hold
  bool tip_in_tissue = false;  ///< false: the tip was in air, or out at the other side; then nothing was dropped
  bool found = false;          ///< the point of the tissue was found
  Triple place{};              ///< where the seed was left, in the room
  Triple straight{};           ///< where a rigid straight needle on the same base would have left it
  Triple axis{};               ///< unit vector of the needle at the seed
  Triple rest{};               ///< the point of the tissue there, undeformed; `place` if it was not found
  Triple lasting{};            ///< part of that point's displacement to which the tissue has crept
  double base_depth_mm = 0.0;  ///< of the step in which the seed was left
  double time_s = 0.0;         ///< of that step
};

/// Asks a running real-time loop about points of the tissue: at which point the needle leaves a seed, and where points
/// are now (Insertion::displacement_at()). The loop answers after its steps, a few displacements at a time, so that no
/// step becomes late by it; both sides are wait-free and do not allocate. While the loop is paused it does not answer.
///
/// A train of seeds is ordered at once (order_train()): a stylet holds its seeds where they are in the room, and each
/// is left when the needle's tip has been drawn back beyond its end.
///
/// A search for the point of a drop takes a displacement or two of each step. In ten steps of 1 ms the tissue under a
/// needle that moves at 20 mm/s moves by at most 0.2 mm; under a needle at rest the search is exact to 0.005 mm.
class TissueProbe {
 public:
  static constexpr std::size_t kPoints = 32;  ///< largest number of watched points
  static constexpr std::size_t kTrain = 24;   ///< largest number of seeds in a train

  struct Answer {
    std::uint32_t order = 0;   ///< number of the order that `drops` belong to; 0: nothing was ordered
    double began_at_mm = 0.0;  ///< Step::base_depth_mm after which the order was begun
    std::size_t drop_count = 0;
    std::array<ProbedDrop, kTrain> drops{};  ///< in the order of the train
    std::uint32_t version = 0;               ///< of the watched points (watch())
    std::size_t count = 0;                   ///< number of watched points
    std::array<Triple, kPoints> now{};       ///< [mm] LPS, their present places
    std::array<bool, kPoints> is_known{};    ///< the place was computed
  };

  /// Orders a drop: the search begins after the next step. One reading thread makes this and the next calls.
  /// @param beyond_tip_mm distance of the seed's centre in front of the tip @return number of the order
  std::uint32_t order_drop(double beyond_tip_mm);
  /// Orders a train, in place of an earlier one. Its seeds keep the places in the room that they have after the next
  /// step. If the tip is not in the tissue then, none of them is dropped.
  /// @param behind_tip_mm distances of the seeds' centres behind the tip, from the tip on, at most kTrain; without one,
  /// seeds of an earlier train that have not been left stay in the needle
  /// @param half_length_mm half of a seed's length @return number of the order
  std::uint32_t order_train(std::span<const double> behind_tip_mm, double half_length_mm);
  /// Sets the points to watch. @param points [mm] LPS undeformed, at most kPoints @return their version
  std::uint32_t watch(std::span<const Vec3> points);
  /// Fetches the newest answer. @return whether it is a new one
  bool fetch() { return answer_.fetch(); }
  [[nodiscard]] const Answer& answer() const { return answer_.value(); }

  /// Answers after a step of the simulation. For the loop's thread.
  void serve(Simulation& simulation) noexcept;

 private:
  struct Order {
    std::uint32_t number = 0;
    std::size_t seeds = 0;
    std::array<double, kTrain> beyond_tip_mm{};
    double half_length_mm = 0.0;
    std::uint32_t version = 0;
    std::size_t count = 0;
    std::array<Triple, kPoints> points{};
  };
  static constexpr int kEachStep = 2;    ///< displacements computed after a step
  static constexpr int kWatchEvery = 4;  ///< steps between two looks at watched points

  void begin_train(const Simulation& simulation);
  void leave_next(const Simulation& simulation);
  void search(Simulation& simulation);
  void look(Simulation& simulation);

  Order wanted_;  ///< used by the reading thread
  LatestValue<Order> order_;
  LatestValue<Answer> answer_;
  // Used by the loop's thread.
  Answer now_;
  std::optional<MaterialSearch> search_;  ///< of the seed that is being left
  std::size_t left_ = 0;                  ///< seeds of the train that are done
  std::size_t next_ = 0;                  ///< watched point to look at next
  int turn_ = 0;
};

}  // namespace stylet
