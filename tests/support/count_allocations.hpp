// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::test {

/// Counts the calls of this thread to the malloc family (malloc, calloc, realloc, aligned_alloc, memalign,
/// posix_memalign, and through them operator new and Eigen) and the calls of free while an object of this class exists.
/// Scopes may be nested; an outer one includes the calls of the inner ones. A test program that uses it compiles
/// count_allocations.cpp, which replaces these functions.
class AllocationCount {
 public:
  AllocationCount();
  [[nodiscard]] long count() const;

  /// False where these functions cannot be replaced (under address, thread and memory sanitizers, and without glibc);
  /// tests then have to be skipped.
  [[nodiscard]] static bool available();

 private:
  long before_;
};

}  // namespace stylet::test
