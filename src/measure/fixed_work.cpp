// SPDX-License-Identifier: GPL-3.0-or-later
#include "fixed_work.hpp"

#include "stylet/measure/timing.hpp"

#include <algorithm>

namespace stylet::measure {

FixedWork::FixedWork(double about_us) {
  constexpr int tries = 20;
  double quickest = 0.0;
  while (quickest < about_us) {
    turns_ *= 2;
    quickest = run();
    for (int k = 1; k < tries; ++k) quickest = std::min(quickest, run());
  }
  turns_ = static_cast<long>(static_cast<double>(turns_) * about_us / quickest);
}

double FixedWork::run() const {
  const double begun = measure::thread_cpu_s();
  work();
  return 1e6 * (measure::thread_cpu_s() - begun);
}

void FixedWork::work() const {
  // Volatile input and output prevent the compiler from computing the result in advance.
  volatile double outside = 2.0;
  double x = outside;
  for (long k = 0; k < turns_; ++k) x = 0.999 * x + 0.001;
  outside = x;
}

}  // namespace stylet::measure
