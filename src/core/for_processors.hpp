// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// GCC compiles a function with this mark for several processors and chooses when the program is loaded. Sanitizers do
/// not support this choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define STYLET_FOR_PROCESSORS __attribute__((target_clones("fma", "default")))
#else
#define STYLET_FOR_PROCESSORS
#endif
#define STYLET_INLINE [[gnu::always_inline]] inline

namespace stylet::dense {

/// Four numbers in one register of AVX, or two of SSE; they may lie at any address.
using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

STYLET_INLINE const Four& four(const double* at) { return *reinterpret_cast<const Four*>(at); }
STYLET_INLINE Four& four(double* at) { return *reinterpret_cast<Four*>(at); }

}  // namespace stylet::dense
