// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/count_allocations.hpp"
#include "support/sanitized.hpp"

#include <cerrno>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(STYLET_SANITIZED_HEAP)
#define STYLET_COUNT_ALLOCATIONS 1
#endif

namespace {

// Constant-initialised and part of the executable, so that reading it in malloc itself never allocates.
thread_local long calls = 0;

}  // namespace

namespace stylet::test {

AllocationCount::AllocationCount() : before_(calls) {}
long AllocationCount::count() const { return calls - before_; }

bool AllocationCount::available() {
#ifdef STYLET_COUNT_ALLOCATIONS
  return true;
#else
  return false;
#endif
}

}  // namespace stylet::test

#ifdef STYLET_COUNT_ALLOCATIONS
extern "C" {

void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* block, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;
void __libc_free(void* block) noexcept;

void* malloc(std::size_t size) noexcept {
  ++calls;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  ++calls;
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  ++calls;
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++calls;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++calls;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  ++calls;
  void* found = __libc_memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *block = found;
  return 0;
}

void free(void* block) noexcept {
  if (block != nullptr) ++calls;
  __libc_free(block);
}

}  // extern "C"
#endif
