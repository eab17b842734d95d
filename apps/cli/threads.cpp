// SPDX-License-Identifier: GPL-3.0-or-later
#include "threads.hpp"

#include <dlfcn.h>

#include <initializer_list>

namespace stylet::cli {

void limit_threads(int most) {
  // The functions are looked up at run time, because the system decides which BLAS and which OpenMP are used.
  for (const char* name : {"openblas_set_num_threads", "omp_set_num_threads"}) {
    if (auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, name))) set(most);
  }
}

}  // namespace stylet::cli
