// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"

#include <cstddef>
#include <functional>

namespace stylet {

/// Bounds the threads of for_each_in_parallel().
/// @param most [threads]; 0 = one per core, as at the start
void set_worker_threads(int most);

/// Calls work(0) … work(count − 1), each once, in any order and on several threads; returns when all are done. Pieces
/// must not depend on each other, so that what comes out does not depend on the number of threads. An exception of a
/// piece is passed on. Not for the step: it starts threads.
/// @param progress is called in the caller's thread
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work,
                          const Progress& progress = {}, std::string_view stage = {});

}  // namespace stylet
