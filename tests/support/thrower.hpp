// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/survive.hpp"

#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stylet::test {

/// As long as it exists, an exception is thrown at a place of survive(), once.
class Thrower {
 public:
  explicit Thrower(const std::string& place) {
    arm(place);
    throw_for_tests = &visit;
  }
  ~Thrower() { throw_for_tests = nullptr; }
  Thrower(const Thrower&) = delete;
  Thrower& operator=(const Thrower&) = delete;

  static void arm(const std::string& place) {
    const std::lock_guard lock(mutex_);
    place_ = place;
    has_thrown_ = false;
  }
  [[nodiscard]] static bool has_thrown() {
    const std::lock_guard lock(mutex_);
    return has_thrown_;
  }

 private:
  static void visit(std::string_view place) {
    const std::lock_guard lock(mutex_);
    if (place != place_ || has_thrown_) return;
    has_thrown_ = true;
    if (place_.size() % 2 == 0) throw 1;  // what is thrown need not be a std::exception
    throw std::runtime_error("[json.exception.type_error.316] words of a library");
  }
  static inline std::mutex mutex_;
  static inline std::string place_;
  static inline bool has_thrown_ = false;
};

}  // namespace stylet::test
