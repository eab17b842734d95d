// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::detail {

/// Limits OpenBLAS to one thread while an object of this class exists; when the last object is destroyed, the previous
/// number is restored. With one thread, sums do not depend on the number of cores, and no pool of threads disturbs a
/// running simulation loop. Has no effect on other BLAS libraries.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

}  // namespace stylet::detail
