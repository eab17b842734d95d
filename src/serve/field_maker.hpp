// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/display_field.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace stylet::serve {

/// Prepares the displacement field of a model in a thread of low priority, while the needle can already move. The model
/// must have such a field (DisplayField::check). The thread waits before it starts, because a browser that opens the
/// page needs the processors too, and priorities count only among the threads of one session or control group.
class FieldMaker {
 public:
  /// @param longest_wait longest time to wait for begin()
  FieldMaker(std::shared_ptr<const Model> model, std::chrono::duration<double> longest_wait);
  ~FieldMaker();  ///< calls give_up() and waits for the thread to end
  /// Ends the wait.
  void begin();
  /// Makes the thread end at its next report of progress; done() is then true and there is no field.
  void give_up();
  FieldMaker(const FieldMaker&) = delete;
  FieldMaker& operator=(const FieldMaker&) = delete;

  /// The part of the work that is done, 0…1.
  [[nodiscard]] double fraction() const { return fraction_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool done() const { return done_.load(std::memory_order_acquire); }
  /// The field. Read it and what follows only when done() is true. Empty: the work was given up, or failed.
  [[nodiscard]] const std::shared_ptr<const DisplayField>& field() const { return made_; }
  /// Why the work failed; empty: it did not.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// Processor time of the work.
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  void wait(std::chrono::duration<double> longest);
  void make(std::shared_ptr<const Model> model);
  void prepare(std::shared_ptr<const Model> model);

  std::mutex mutex_;
  std::condition_variable woken_;
  bool begins_ = false;
  std::atomic<double> fraction_ = 0.0;
  std::atomic<bool> given_up_ = false;
  std::atomic<bool> done_ = false;
  std::shared_ptr<const DisplayField> made_;
  std::string problem_;
  double seconds_ = 0.0;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
