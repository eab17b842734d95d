// SPDX-License-Identifier: GPL-3.0-or-later
#include "threads.hpp"

#include <dlfcn.h>

#include <initializer_list>

namespace stylet::cli {

void limit_threads(int most) {
  // Looked up at run time: which BLAS and which OpenMP there is, is the system's choice.
  for (const char* name : {"openblas_set_num_threads", "omp_set_num_threads"}) {
    if (auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, name))) set(most);
  }
}

}  // namespace stylet::cli
