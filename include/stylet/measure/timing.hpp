// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

/// Every benchmark, and the clocks and the machine's name that they share.
namespace stylet::measure {

/// Processor time of this thread [s].
double thread_cpu_s();

/// Wall-clock time from a monotonic clock [s].
double wall_s();

/// Processor time of one call [s].
template <class Work>
double cpu_seconds(Work&& work) {
  const double before = thread_cpu_s();
  work();
  return thread_cpu_s() - before;
}

/// Largest accepted relative difference between the results of timed methods; a larger one is an error.
inline constexpr double kLargestDifference = 1e-8;

/// Median; with an even number of values, the mean of the two in the middle. NaN without values.
double median(std::vector<double> values);

/// The machine on which the times were measured.
struct Machine {
  std::string processor;  ///< name reported by the system
  int cores = 0;
  std::string blas;      ///< name, version and kernel reported by the library; empty if it reports none
  int blas_threads = 0;  ///< threads during the measurement; 0 if they cannot be set (not OpenBLAS)
  std::string compiler;
};
Machine this_machine();

}  // namespace stylet::measure
