// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/serve/picture.hpp"

#include <atomic>
#include <optional>
#include <utility>

namespace stylet::serve {

/// Whether the companion may give commands beside the pages, and why its present command is refused.
class CompanionTurn {
 public:
  /// Says whether a page holds the needle. May be called from any thread.
  void hold(bool is_held) { is_held_ = is_held; }
  /// While pages move the needle, the page that holds it comes first.
  /// @param device what moves the needle (SessionStatus::device)
  [[nodiscard]] bool may_command(const std::string& device) const { return !is_held_ || device != "page"; }
  void begin() { refused_.reset(); }
  void refuse(const Notice& why) { refused_ = why; }
  /// Why the command since begin() was refused; empty: it was not.
  std::optional<Notice> end() { return std::exchange(refused_, {}); }

 private:
  std::atomic<bool> is_held_ = false;
  std::optional<Notice> refused_;
};

}  // namespace stylet::serve
