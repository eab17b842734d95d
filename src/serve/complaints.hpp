// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <chrono>
#include <functional>
#include <mutex>
#include <string>

namespace stylet::serve {

/// Tells of work that an exception has ended (survive()) on the terminal. Work that fails in every turn is told once in
/// a while. May be called from any thread.
class Complaints {
 public:
  /// @param say prints on the terminal; may be empty
  explicit Complaints(std::function<void(const std::string&)> say) : say_(std::move(say)) {}

  /// @return whether it was new and so has been told
  bool tell(const Error& why);

 private:
  std::function<void(const std::string&)> say_;
  std::mutex mutex_;  ///< guards the members below
  std::string last_;
  std::chrono::steady_clock::time_point again_;
};

}  // namespace stylet::serve
