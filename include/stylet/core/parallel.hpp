// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"

#include <cstddef>
#include <functional>

namespace stylet {

/// Sets the largest number of threads that for_each_in_parallel() uses.
/// @param most [threads]; 0, the initial value, stands for one thread per core
void set_worker_threads(int most);

/// Calls work(0) … work(count − 1), each once, in any order and on several threads, and returns when all calls have
/// returned. The calls must not depend on each other, so that the result does not depend on the number of threads. The
/// first exception that a call throws is thrown again in the caller's thread, and the remaining calls are skipped.
/// Starts threads, so it must not be called in a simulation step.
/// @param progress is called in the caller's thread only
/// @param stage name of the stage, passed to `progress`
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work,
                          const Progress& progress = {}, std::string_view stage = {});

/// [s] Processor time of the calling thread, and of the threads that for_each_in_parallel() has started for it.
[[nodiscard]] double work_seconds();

}  // namespace stylet
