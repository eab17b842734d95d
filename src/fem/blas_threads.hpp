// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::detail {

/// Holds OpenBLAS at one thread while it lives, and gives the previous number back when the last holder dies: sums then
/// do not depend on the number of cores, and no pool of threads disturbs a running loop. Does nothing with another
/// BLAS.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

}  // namespace stylet::detail
