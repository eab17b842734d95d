// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/need.hpp"
#include "stylet/evidence/validate/context.hpp"

#include <utility>

/// Measurements end at the first thing that they need and do not get: measure() catches Failed, which gives a crashed
/// row, and Skipped.
namespace stylet::validate {

/// Gives a skipped row.
struct Skipped {
  std::string why;
};

/// The path of a file of the shared data. Throws Skipped where there is none.
inline std::filesystem::path need_file(const Context& context, const std::string& file) {
  if (auto path = context.data(file)) return *std::move(path);
  throw Skipped{context.no_data(file)};
}

}  // namespace stylet::validate
