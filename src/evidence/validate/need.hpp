// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/validate/context.hpp"

#include <utility>

/// Measurements end at the first thing that they need and do not get. measure() catches both of these.
namespace stylet::validate {

/// Gives a crashed row.
struct Failed {
  Error error;
};

/// Gives a skipped row.
struct Skipped {
  std::string why;
};

/// The value of a result. Throws Failed with its error where there is none.
template <class T>
T need(Result<T> result) {
  if (!result) throw Failed{result.error()};
  return *std::move(result);
}

/// The path of a file of the shared data. Throws Skipped where there is none.
inline std::filesystem::path need_file(const Context& context, const std::string& file) {
  if (auto path = context.data(file)) return *std::move(path);
  throw Skipped{context.no_data(file)};
}

}  // namespace stylet::validate
