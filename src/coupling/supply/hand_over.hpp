// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/supply/parcel.hpp"

#include <atomic>

namespace stylet {

/// The hand-over of the parcel between the threads of step and worker, and the messages that go with it. One side has
/// the parcel at a time; only that side may read or change it, and only that side can give it to the other. Nothing
/// here waits, and nothing allocates except the parcel's own lists.
///
/// A call is a request to work until no compliance is missing. A thread that cannot continue without rows makes a call,
/// gives the parcel to the worker each time it comes back, and waits until the call is answered, which means that
/// nothing was missing when the worker last had the parcel.
class SupplyHandOver {
 public:
  using Work = ComplianceSupply::Work;

  /// Only for the side that has the parcel.
  [[nodiscard]] SupplyParcel& parcel() noexcept { return parcel_; }

  // --- The step's side.

  [[nodiscard]] bool with_step() const noexcept { return !with_worker(); }
  /// Gives the parcel to the worker, together with the place of the needle.
  void give_to_worker(const NeedleWhereabouts& needle) noexcept {
    parcel_.needle = needle;
    parcel_.call = call_;
    with_worker_.store(true, std::memory_order_release);
  }
  /// Makes a call. Work that was finished before does not answer it.
  void call() noexcept { ++call_; }
  [[nodiscard]] bool answered() const noexcept { return answered_.load(std::memory_order_acquire) == call_; }
  /// Whether the last round of the worker failed.
  [[nodiscard]] bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }

  // --- The worker's side.

  [[nodiscard]] bool with_worker() const noexcept { return with_worker_.load(std::memory_order_acquire); }
  /// Gives the parcel to the step after a round of work with the result `done`.
  void give_to_step(Work done) noexcept {
    const unsigned call = parcel_.call;
    failed_.store(done == Work::failed, std::memory_order_relaxed);
    if (done != Work::done && done != Work::waiting) answered_.store(call, std::memory_order_release);
    with_worker_.store(false, std::memory_order_release);
  }

  // --- A worker on a thread of its own begins and ends; not to be called while a step is running.

  void open() noexcept { open_.store(true, std::memory_order_release); }
  void close() noexcept { open_.store(false, std::memory_order_release); }
  /// Whether a worker is running on a thread of its own.
  [[nodiscard]] bool is_open() const noexcept { return open_.load(std::memory_order_acquire); }

 private:
  SupplyParcel parcel_;
  std::atomic<bool> with_worker_ = false;
  std::atomic<bool> open_ = false;
  std::atomic<bool> failed_ = false;
  std::atomic<unsigned> answered_ = 0;  ///< number of the last call that was answered
  unsigned call_ = 0;                   ///< of the step's side: number of the last call
};

}  // namespace stylet
