// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/timing.hpp"

#include "core/clock.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <thread>

namespace stylet::measure {

namespace {

/// The value of the first line "key : value" of a file; empty if there is none.
std::string line_of(const char* file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

/// Calls a function of OpenBLAS that returns a text. The function is looked up at run time, because the system's
/// alternatives may select another BLAS.
std::string asked(const char* function) {
  const auto call = reinterpret_cast<const char* (*)()>(dlsym(RTLD_DEFAULT, function));
  return call == nullptr ? std::string() : std::string(call());
}

}  // namespace

double wall_s() { return 1e-9 * static_cast<double>(monotonic_ns()); }

double thread_cpu_s() { return 1e-9 * static_cast<double>(thread_cpu_ns()); }

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Machine this_machine() {
  Machine machine;
  machine.processor = line_of("/proc/cpuinfo", "model name");
  if (machine.processor.empty()) machine.processor = "unknown processor";
  machine.cores = static_cast<int>(std::thread::hardware_concurrency());
  // "OpenBLAS 0.3.21 NO_LAPACKE DYNAMIC_ARCH NO_AFFINITY Zen MAX_THREADS=64": name, version, kernel.
  const std::string config = asked("openblas_get_config");
  const std::string kernel = asked("openblas_get_corename");
  const std::size_t name = config.find(' ');
  const std::size_t version = name == std::string::npos ? name : config.find(' ', name + 1);
  machine.blas = config.substr(0, version);
  if (!kernel.empty()) machine.blas += ", kernel " + kernel;
  if (dlsym(RTLD_DEFAULT, "openblas_set_num_threads") != nullptr) machine.blas_threads = 1;  // OneBlasThread
#if defined(__clang__)
  machine.compiler = std::string("clang ") + __clang_version__;
#else
  machine.compiler = std::string("g++ ") + __VERSION__;
#endif
  return machine;
}

}  // namespace stylet::measure
