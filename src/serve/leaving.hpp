// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace stylet::serve {

/// Workers that nobody needs any more and whose threads have not ended. A thread may be factorising, and that takes
/// long, so their destructors are not waited for.
class Leaving {
 public:
  /// Makes a worker end its work; null: there is none.
  template <class Worker>
  void add(std::shared_ptr<Worker> worker) {
    if (!worker) return;
    worker->give_up();
    done_.emplace_back([worker = std::move(worker)] { return worker->done(); });
  }
  void forget_ended() {
    std::erase_if(done_, [](const auto& done) { return done(); });
  }

 private:
  std::vector<std::function<bool()>> done_;  ///< they hold the workers
};

}  // namespace stylet::serve
