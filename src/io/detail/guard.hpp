// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/child.hpp"
#include "detail/wire.hpp"

#include <filesystem>
#include <functional>
#include <new>

namespace stylet::detail {

/// Limits for reading one file: generous for honest files of its size, short enough that a trap does not look like a
/// hang.
ChildLimits limits_for(const std::filesystem::path& path);

/// The error a parser's end without a result becomes.
Error died(const std::filesystem::path& path, const ChildOutcome& outcome, const ChildLimits& limits);

/// The error an exception becomes.
Error threw(const std::filesystem::path& path, const char* what);
Error out_of_memory(const std::filesystem::path& path);

/// Runs a parser on an untrusted file in a child process (child.hpp); its crash, hang or exception becomes an input
/// error.
template <class T>
Result<T> guarded(const std::filesystem::path& path, const std::function<Result<T>()>& parse) {
  const auto work = [&]() -> std::string {
    Result<T> result = [&]() -> Result<T> {
      try {
        return parse();
      } catch (const std::bad_alloc&) {
        return out_of_memory(path);
      } catch (const std::exception& error) {
        return threw(path, error.what());
      } catch (...) {
        return threw(path, "unknown exception");
      }
    }();
    return to_bytes(result);
  };
  const ChildLimits limits = limits_for(path);
  const ChildOutcome outcome = run_in_child(work, limits);
  if (outcome.end != ChildEnd::finished) return died(path, outcome, limits);
  try {
    return from_bytes<T>(outcome.result);
  } catch (const std::exception& error) {
    return threw(path, error.what());
  }
}

}  // namespace stylet::detail
