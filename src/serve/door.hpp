// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace stylet::serve {

/// Counts open connections, in all and per address, so that one visitor cannot use up what all need. Any thread
/// may call, and end a pass.
class Door {
 public:
  Door(std::size_t most, std::size_t most_per_address) : most_(most), most_per_address_(most_per_address) {}

  /// Lets a connection in. It counts as open until the last copy of the pass is gone. @return null: there are too many
  [[nodiscard]] std::shared_ptr<const void> enter(const std::string& address);
  [[nodiscard]] std::size_t open() const;

 private:
  struct Count {
    std::mutex mutex;
    std::size_t all = 0;
    std::map<std::string, std::size_t> of_address;
  };
  std::size_t most_, most_per_address_;
  std::shared_ptr<Count> count_ = std::make_shared<Count>();  ///< passes may outlive the door
};

}  // namespace stylet::serve
