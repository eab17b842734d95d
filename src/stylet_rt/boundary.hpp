// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/stylet_rt.h"

#include <new>
#include <string_view>

namespace stylet::rt {

/// Writes messages into the caller's buffer: zero-terminated, and cut to fit without splitting UTF-8 characters.
class ErrorText {
 public:
  ErrorText(char* text, std::size_t size) noexcept : text_(size > 0 ? text : nullptr), size_(size) { say({}); }

  void say(std::string_view message) noexcept;

  [[nodiscard]] stylet_rt_status bad_argument(std::string_view message) noexcept {
    say(message);
    return STYLET_RT_BAD_ARGUMENT;
  }
  [[nodiscard]] stylet_rt_status of(const Error& error) {
    say(error.message());
    return error.kind == ErrorKind::input ? STYLET_RT_INPUT_ERROR : STYLET_RT_FAILED;
  }

 private:
  char* text_;
  std::size_t size_;
};

/// Calls `body` and converts its exceptions to a status and a message.
template <class Body>
stylet_rt_status guarded(ErrorText& error, const Body& body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    error.say("out of memory");
    return STYLET_RT_OUT_OF_MEMORY;
  } catch (...) {
    error.say("an unexpected fault ended the call");
    return STYLET_RT_FAILED;
  }
}

/// Calls `body` and converts its exceptions to a status, without a message.
template <class Body>
stylet_rt_status guarded(const Body& body) noexcept {
  ErrorText nowhere(nullptr, 0);
  return guarded(nowhere, body);
}

}  // namespace stylet::rt
