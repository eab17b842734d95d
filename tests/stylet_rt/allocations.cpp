// SPDX-License-Identifier: GPL-3.0-or-later
// AllocationCount for C: number of allocations and releases of the thread; -1 if they cannot be counted.
#include "support/count_allocations.hpp"

extern "C" long allocations_so_far(void);

long allocations_so_far(void) {
  if (!stylet::test::AllocationCount::available()) return -1;
  static const stylet::test::AllocationCount since_the_first_call;
  return since_the_first_call.count();
}
