// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "other_needles.hpp"
#include "stylet/serve/picture.hpp"
#include "stylet/sim/hole_map.hpp"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace stylet::serve {

/// Makes the map of the template's holes in a thread of low priority, while the needle moves: first the clearances,
/// then on request the simulated insertion through each hole. It keeps the mesh of the case, not its model.
class MapMaker {
 public:
  /// @param plan_of gives the insertion through a hole; called in the maker's thread
  MapMaker(const std::shared_ptr<const Model>& model, PlanOfHole plan_of);
  ~MapMaker();  ///< calls give_up() and waits for the thread to end
  MapMaker(const MapMaker&) = delete;
  MapMaker& operator=(const MapMaker&) = delete;

  /// Starts or stops the simulated insertions through the holes that have no prediction. A hole whose simulation is
  /// stopped is simulated from its start next time.
  void want_predictions(bool wanted);
  /// Makes the thread end at its next report of progress.
  void give_up();
  /// Whether the thread has ended.
  [[nodiscard]] bool done() const { return done_.load(std::memory_order_acquire); }

  /// The map as far as it is made; empty if it has not changed since the last call.
  [[nodiscard]] std::optional<LiveMap> news();

 private:
  void make(const std::shared_ptr<const Model>& model);
  [[nodiscard]] std::optional<std::size_t> next_hole();
  void predict(std::size_t hole);

  PlanOfHole plan_of_;
  OtherNeedles needles_;
  KnownTargets targets_;  ///< used by the thread only
  std::atomic<bool> given_up_ = false;
  std::atomic<bool> wanted_ = false;
  std::atomic<bool> done_ = false;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable woken_;
  LiveMap state_;
  bool changed_ = false;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
