// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/flush_denormals.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace stylet {

namespace {

#if defined(__SSE2__)
constexpr unsigned long kFlush = 0x8040;  // FTZ and DAZ of MXCSR
unsigned long mode() { return _mm_getcsr(); }
void set_mode(unsigned long value) { _mm_setcsr(static_cast<unsigned>(value)); }
#elif defined(__aarch64__)
constexpr unsigned long kFlush = 1ul << 24;  // FZ of FPCR
unsigned long mode() {
  unsigned long value = 0;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void set_mode(unsigned long value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#else
constexpr unsigned long kFlush = 0;
unsigned long mode() { return 0; }
void set_mode(unsigned long /*value*/) {}
#endif

}  // namespace

FlushDenormals::FlushDenormals() : before_(mode()) { set_mode(before_ | kFlush); }
FlushDenormals::~FlushDenormals() { set_mode(before_); }
bool FlushDenormals::available() { return kFlush != 0; }

}  // namespace stylet
