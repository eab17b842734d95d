// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/compliance_worker.hpp"

#include "stylet/core/survive.hpp"
#include "thread_setup.hpp"

#include <chrono>

namespace stylet {
namespace {

/// Number of nodes solved for at once. A larger number would be cheaper per node, but delay the first node.
constexpr std::size_t kAtOnce = 16;
constexpr auto kLook = std::chrono::milliseconds(1);
constexpr int kLooksAfterFailure = 1000;

}  // namespace

ComplianceWorker::ComplianceWorker(ComplianceSupply& supply, const ComplianceSupply::Settings& settings)
    : supply_(supply) {
  supply_.open(settings);
  try {
    thread_ = std::thread([this] { run(); });
  } catch (...) {
    supply_.close();
    throw;
  }
}

ComplianceWorker::~ComplianceWorker() {
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
  supply_.close();
}

void ComplianceWorker::run() noexcept {
  yield_to_others();
  while (!stop_.load(std::memory_order_relaxed)) {
    using Work = ComplianceSupply::Work;
    Work done = Work::failed;
    survive(
        "the compliance ahead of the needle", [&] { done = supply_.work(kAtOnce); }, [](const Error&) {});
    if (done == Work::done) continue;
    // After a failure to allocate memory, wait longer before the next attempt.
    const int looks = done == Work::failed ? kLooksAfterFailure : 1;
    for (int k = 0; k < looks && !stop_.load(std::memory_order_relaxed); ++k) std::this_thread::sleep_for(kLook);
  }
}

}  // namespace stylet
