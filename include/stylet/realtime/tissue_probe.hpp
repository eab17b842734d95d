// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/latest_value.hpp"
#include "stylet/realtime/tissue_messages.hpp"
#include "stylet/sim/material_search.hpp"
#include "stylet/sim/simulation.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace stylet {

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
  static constexpr std::size_t kPoints = kWatchedPoints;
  static constexpr std::size_t kTrain = kTrainSeeds;

  using Answer = TissueAnswer;

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
  static constexpr int kEachStep = 2;    ///< displacements computed after a step
  static constexpr int kWatchEvery = 4;  ///< steps between two looks at watched points

  void begin_train(const Simulation& simulation);
  void leave_next(const Simulation& simulation);
  void search(Simulation& simulation);
  void look(Simulation& simulation);

  TissueOrder wanted_;  ///< used by the reading thread
  LatestValue<TissueOrder> order_;
  LatestValue<Answer> answer_;
  // Used by the loop's thread.
  Answer now_;
  std::optional<MaterialSearch> search_;  ///< of the seed that is being left
  std::size_t left_ = 0;                  ///< seeds of the train that are done
  std::size_t next_ = 0;                  ///< watched point to look at next
  int turn_ = 0;
};

}  // namespace stylet
