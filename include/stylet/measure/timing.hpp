// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

/// The experiments of Goksel et al. 2005 and their figures, made again.
namespace stylet::measure {

/// Processor time of this thread [s].
double thread_cpu_s();

/// A clock on the wall that only goes forward [s].
double wall_s();

/// Processor time of one call [s].
template <class Work>
double cpu_seconds(Work&& work) {
  const double before = thread_cpu_s();
  work();
  return thread_cpu_s() - before;
}

/// Results of methods that are timed may differ by this much, relatively; beyond it nothing is reported.
inline constexpr double kLargestDifference = 1e-8;

/// Median; of an even number of values the mean of the two in the middle. NaN of none.
double median(std::vector<double> values);

/// What the times were measured on.
struct Machine {
  std::string processor;  ///< as the system names it
  int cores = 0;
  std::string blas;      ///< name, version and kernel as the library tells them; empty where it tells nothing
  int blas_threads = 0;  ///< while measuring; 0 where it cannot be set: another BLAS than OpenBLAS
  std::string compiler;
};
Machine this_machine();

}  // namespace stylet::measure
