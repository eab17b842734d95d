// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hand.hpp"

#include <memory>
#include <mutex>
#include <utility>

namespace stylet::serve {

/// The needle that the pages' hands move now, if there is one. Any thread may call.
class HeldHand {
 public:
  /// @param device null: the hands move nothing from now on
  void give(std::shared_ptr<PageDevice> device) {
    const std::lock_guard lock(mutex_);
    device_ = std::move(device);
  }
  void aim(const HandTarget& target) {
    const std::lock_guard lock(mutex_);
    if (device_) device_->aim(target);
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<PageDevice> device_;
};

}  // namespace stylet::serve
