// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <atomic>
#include <string>
#include <string_view>
#include <utility>

namespace stylet {

/// The exception that is being handled as an error in words of our own: memory that ran out, a refusal of the system
/// with its reason, or a fault of the program. Call it in a catch block.
[[nodiscard]] Error caught_exception(const std::string& where);

/// Tests set this to a function that throws at the places that survive() names; otherwise it is null.
using ThrowForTests = void (*)(std::string_view place);
inline std::atomic<ThrowForTests> throw_for_tests = nullptr;

/// Does a piece of work so that no exception ends the program. It stands at the root of every thread and around every
/// piece of work that may fail alone: a request, a picture, a model.
/// @param place the work in a few words, which become Error::where
/// @param tell receives the error of an exception
/// @return whether the work ended without an exception
template <class Work, class Tell>
bool survive(std::string_view place, Work&& work, Tell&& tell) noexcept {
  try {
    if (const ThrowForTests hook = throw_for_tests.load(std::memory_order_relaxed)) hook(place);
    std::forward<Work>(work)();
    return true;
  } catch (...) {
    try {
      std::forward<Tell>(tell)(caught_exception(std::string(place)));
    } catch (...) {  // there is not even memory for the message
    }
    return false;
  }
}

}  // namespace stylet
