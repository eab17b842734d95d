// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shelf.hpp"
#include "stylet/implant/recorded_implant.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace stylet::serve {

/// An implant that has not come to its end, as the recording of its last needle has it.
struct InterruptedImplant {
  std::string recording;           ///< name on the shelf
  std::int64_t recorded_s = 0;     ///< [s] since 1970, when it was last written
  std::vector<SeedHistory> seeds;  ///< in the tissue, in the order in which they were dropped; at least one
  std::size_t needle = 0;          ///< of the recording; for one beside the plan, that of the last seed
  std::string name;                ///< of the implant
  ImplantTally tally;              ///< of all its needles
};

/// Looks for an implant of a plan that was interrupted. The newest recording of the plan in which something was done to
/// the seeds decides: it is interrupted if some of its seeds, but not all, are in the tissue.
/// @param given_up ends the search @return empty: there is none
std::optional<InterruptedImplant> find_interrupted(const Shelf& shelf, const RecordedPlan& plan,
                                                   const std::atomic<bool>& given_up);

/// This search in a thread of its own.
class ImplantSearch {
 public:
  ImplantSearch(Shelf shelf, const RecordedPlan& plan);
  ~ImplantSearch() { give_up(); }  ///< waits for the thread to end
  ImplantSearch(const ImplantSearch&) = delete;
  ImplantSearch& operator=(const ImplantSearch&) = delete;

  void give_up() { given_up_ = true; }
  /// Whether the thread has ended.
  [[nodiscard]] bool done() const { return done_.load(std::memory_order_acquire); }
  /// What it has found; null: nothing, or nothing yet.
  [[nodiscard]] const InterruptedImplant* found() const { return done() && found_ ? &*found_ : nullptr; }

 private:
  std::atomic<bool> given_up_ = false;
  std::atomic<bool> done_ = false;
  std::optional<InterruptedImplant> found_;  ///< written by the thread until it is done
  std::jthread thread_;                      ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
