// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/compliance_supply.hpp"

#include <thread>

namespace stylet {

/// A thread that computes compliance ahead of a needle while another thread takes the steps: the worker's side of a
/// ComplianceSupply. It has ordinary scheduling with low priority, and nothing to do while the needle stays in the
/// prepared corridor. If the needle outruns it, steps are flagged (Step::compliance_missing).
class ComplianceWorker {
 public:
  /// Starts the thread; throws std::system_error if the system provides none. No step may be in progress.
  /// @param supply must outlive the worker
  ComplianceWorker(ComplianceSupply& supply, const ComplianceSupply::Settings& settings);
  /// Ends the thread after its present unit of work, which may be the factorisation of a model from a file. No step may
  /// be in progress.
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
