// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

// Whether the tests run under a sanitizer that watches memory, which makes them many times slower.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define STYLET_SANITIZED_HEAP 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define STYLET_SANITIZED_HEAP 1
#endif
#endif

namespace stylet::test {

#if defined(STYLET_SANITIZED_HEAP)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Why a test that compares meshes does not run under sanitizers.
inline constexpr const char* kTooLongSanitized =
    "It takes minutes under a sanitizer, where shorter tests execute the same code.";

/// Cells along an edge of the meshes on which a test runs: under sanitizers only those of the first one.
inline std::vector<int> meshes(const std::vector<int>& cells) {
  return kSanitized ? std::vector<int>{cells.front()} : cells;
}

}  // namespace stylet::test
