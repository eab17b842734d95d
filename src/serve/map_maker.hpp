// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/serve/picture.hpp"
#include "stylet/sim/hole_map.hpp"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace stylet::serve {

/// Makes the map of a case's template in a thread of low priority, while the needle moves: the clearances at once, and
/// what a needle through each hole would do when it is asked for. It keeps the case's mesh, not its model.
class MapMaker {
 public:
  /// @param plan_of called in the maker's thread
  MapMaker(const std::shared_ptr<const Model>& model, PlanOfHole plan_of);
  ~MapMaker();  ///< gives up, and waits until the thread has seen it
  MapMaker(const MapMaker&) = delete;
  MapMaker& operator=(const MapMaker&) = delete;

  /// Whether a needle is to be inserted through each hole that has no prediction yet. A hole that is begun when they
  /// are no longer wanted is begun again when they are.
  void want_predictions(bool wanted);
  /// Ends at the next report of progress.
  void give_up();
  /// Whether the thread has ended.
  [[nodiscard]] bool done() const { return done_.load(std::memory_order_acquire); }

  /// What there is by now, if it has changed since the last call.
  [[nodiscard]] std::optional<LiveMap> news();

 private:
  void make(const std::shared_ptr<const Model>& model);
  [[nodiscard]] std::optional<std::size_t> next_hole();
  void predict(std::size_t hole);

  PlanOfHole plan_of_;
  Scenario scenario_;
  TetMesh mesh_;
  OwnParts own_;
  KnownTargets targets_;  ///< the thread's own
  std::atomic<bool> given_up_ = false;
  std::atomic<bool> wanted_ = false;
  std::atomic<bool> done_ = false;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable woken_;
  LiveMap state_;
  bool changed_ = false;
  std::jthread thread_;  ///< last: starts when the others exist
};

}  // namespace stylet::serve
