// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/child.hpp"
#include "detail/wire.hpp"
#include "stylet/core/printable.hpp"

#include <filesystem>
#include <functional>
#include <new>

namespace stylet::detail {

/// Limits for reading one file or searching one folder: generous for valid files of its packed and unpacked size, but
/// short enough that a malicious file does not seem to hang the program. The unpacked size that a file claims is
/// bounded by the largest ratio that deflate can achieve.
ChildLimits limits_for(const std::filesystem::path& path);

/// The default cure in the error about a file that crashes its parser.
inline constexpr const char* kExportAgain =
    "The file is damaged or violates its format; export it again or in another format";

/// The error for a parser that ended without a result.
Error died(const std::filesystem::path& path, const ChildOutcome& outcome, const ChildLimits& limits, const char* cure);

/// The error for an exception.
Error threw(const std::filesystem::path& path, const char* what, const char* cure);
Error out_of_memory(const std::filesystem::path& path);

/// Runs a parser on an untrusted file in a child process (child.hpp). A crash, hang or exception becomes an input
/// error.
/// @param cure last clause of that error
template <class T>
Result<T> guarded(const std::filesystem::path& path, const std::function<Result<T>()>& parse,
                  const char* cure = kExportAgain) {
  const auto work = [&]() -> std::string {
    Result<T> result = [&]() -> Result<T> {
      try {
        return parse();
      } catch (const std::bad_alloc&) {
        return out_of_memory(path);
      } catch (const std::exception& error) {
        return threw(path, error.what(), cure);
      } catch (...) {
        return threw(path, "unknown exception", cure);
      }
    }();
    if (result) return to_bytes(result);
    // Errors quote words of the file.
    const Error& error = result.error();
    Result<T> safe(Error{error.kind, printable(error.where), printable(error.what), printable(error.cure)});
    return to_bytes(safe);
  };
  const ChildLimits limits = limits_for(path);
  const ChildOutcome outcome = run_in_child(work, limits);
  if (outcome.end != ChildEnd::finished) return died(path, outcome, limits, cure);
  try {
    return from_bytes<T>(outcome.result);
  } catch (const std::exception& error) {
    return threw(path, error.what(), cure);
  }
}

}  // namespace stylet::detail
