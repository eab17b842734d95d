// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/compliance_supply.hpp"

#include <thread>

namespace stylet {

/// A thread that keeps compliance ahead of a needle while somebody else steps it: the worker's side of a
/// ComplianceSupply. Ordinary scheduling, less urgent than its neighbours. It has nothing to do while the needle stays
/// in the prepared corridor. A needle may outrun it: a step then says so (Step::compliance_missing).
class ComplianceWorker {
 public:
  /// Starts the thread; std::system_error when there is none to be had. No step may be under way.
  /// @param supply outlives the worker
  ComplianceWorker(ComplianceSupply& supply, const ComplianceSupply::Settings& settings);
  /// Waits for the end of a round, which may be that of making the factor of a model from a file. No step may be under
  /// way.
  ~ComplianceWorker();
  ComplianceWorker(const ComplianceWorker&) = delete;
  ComplianceWorker& operator=(const ComplianceWorker&) = delete;

 private:
  void run() noexcept;

  ComplianceSupply& supply_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace stylet
