// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::test {

/// Counts the calls of this thread to the malloc family (malloc, calloc, realloc, aligned_alloc, memalign,
/// posix_memalign, and so operator new and Eigen) while it lives, and those that give a block back (free). Scopes nest:
/// an outer one counts the inner one's too. A test program that uses it compiles count_allocations.cpp in, which
/// replaces those functions.
class AllocationCount {
 public:
  AllocationCount();
  [[nodiscard]] long count() const;

  /// False where the functions cannot be replaced (address, thread and memory sanitizers, other than glibc): skip then.
  [[nodiscard]] static bool available();

 private:
  long before_;
};

}  // namespace stylet::test
