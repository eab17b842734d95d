// SPDX-License-Identifier: GPL-3.0-or-later
#include "blas_threads.hpp"

#include <dlfcn.h>

#include <mutex>

namespace stylet::detail {
namespace {

// The functions are looked up at run time because Debian's alternatives choose the BLAS, and only OpenBLAS has them.
struct OpenBlas {
  void (*set)(int) = nullptr;
  int (*get)() = nullptr;
  OpenBlas() {
    set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    get = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  }
};

const OpenBlas& openblas() {
  static const OpenBlas instance;
  return instance;
}

std::mutex mutex;
int holders = 0;
int threads_before = 1;

}  // namespace

OneBlasThread::OneBlasThread() {
  if (openblas().set == nullptr || openblas().get == nullptr) return;
  const std::scoped_lock lock(mutex);
  if (holders++ == 0) {
    threads_before = openblas().get();
    openblas().set(1);
  }
}

OneBlasThread::~OneBlasThread() {
  if (openblas().set == nullptr || openblas().get == nullptr) return;
  const std::scoped_lock lock(mutex);
  if (--holders == 0) openblas().set(threads_before);
}

}  // namespace stylet::detail
