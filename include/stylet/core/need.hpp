// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

namespace stylet {

/// The end of work that needs something and does not get it. Programs and measurements catch it in one place; no public
/// function throws it.
struct Failed {
  Error error;
};

/// The value of a result. Throws Failed with its error where there is none.
template <class T>
T need(Result<T> result) {
  if (!result) throw Failed{result.error()};
  return *std::move(result);
}

}  // namespace stylet
