// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/display_field.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

namespace stylet::serve {

/// Prepares the displacement field of a model, which must be one that has such a field (DisplayField::check), in a
/// thread of low priority, while the needle moves already. It waits a while before it starts: a browser that opens the
/// page needs the processors as well, and priorities count only among the threads of one session or control group.
class FieldMaker {
 public:
  /// @param longest_wait until begin()
  FieldMaker(std::shared_ptr<const Model> model, std::chrono::duration<double> longest_wait);
  ~FieldMaker();  ///< gives up, and waits until the thread has seen it
  /// Ends the wait.
  void begin();
  /// Ends at the next report of progress; done() then, without a field.
  void give_up();
  FieldMaker(const FieldMaker&) = delete;
  FieldMaker& operator=(const FieldMaker&) = delete;

  /// 0…1, of how much is done.
  [[nodiscard]] double fraction() const { return fraction_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool done() const { return done_.load(std::memory_order_acquire); }
  /// When it is done. Empty: given up, or there was too little memory.
  [[nodiscard]] const std::shared_ptr<const DisplayField>& field() const { return made_; }

 private:
  void wait(std::chrono::duration<double> longest);
  void make(std::shared_ptr<const Model> model);

  std::mutex mutex_;
  std::condition_variable woken_;
  bool begins_ = false;
  std::atomic<double> fraction_ = 0.0;
  std::atomic<bool> given_up_ = false;
  std::atomic<bool> done_ = false;
  std::shared_ptr<const DisplayField> made_;
  std::jthread thread_;  ///< last: starts when the others exist
};

}  // namespace stylet::serve
