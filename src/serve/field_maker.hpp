// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/display_field.hpp"

#include <atomic>
#include <memory>
#include <thread>

namespace stylet::serve {

/// Prepares the displacement field of a model, which must be one that has such a field (DisplayField::check), in a
/// thread of low priority, while the needle moves already.
class FieldMaker {
 public:
  explicit FieldMaker(std::shared_ptr<const Model> model);
  ~FieldMaker();  ///< gives up, and waits until the thread has seen it
  /// Ends at the next report of progress; done() then, without a field.
  void give_up() { given_up_ = true; }
  FieldMaker(const FieldMaker&) = delete;
  FieldMaker& operator=(const FieldMaker&) = delete;

  /// 0…1, of how much is done.
  [[nodiscard]] double fraction() const { return fraction_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool done() const { return done_.load(std::memory_order_acquire); }
  /// When it is done. Empty: given up, or there was too little memory.
  [[nodiscard]] const std::shared_ptr<const DisplayField>& field() const { return made_; }

 private:
  void make(std::shared_ptr<const Model> model);

  std::atomic<double> fraction_ = 0.0;
  std::atomic<bool> given_up_ = false;
  std::atomic<bool> done_ = false;
  std::shared_ptr<const DisplayField> made_;
  std::jthread thread_;  ///< last: starts when the others exist
};

}  // namespace stylet::serve
