// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/wire.hpp"
#include "reading/task.hpp"

#include <string>

namespace stylet::test {

/// The tasks of a reading program that misbehaves as a parser can that is broken or taken over
/// (misbehaving_reader.cpp). An errno is 0 if the attempt succeeded.
inline constexpr detail::Task<ContourSet, ContourSet> kEchoContours{"echo_contours"};
inline constexpr detail::Task<LabelImage, LabelImage> kEchoImage{"echo_image"};
inline constexpr detail::Task<TetMesh, int> kManyNodes{"many_nodes"};
inline constexpr detail::Task<bool, std::string> kEnd{"end"};         ///< ends in this way
inline constexpr detail::Task<int, std::string> kAttempt{"attempt"};  ///< errno of an attempt; the path is a file
inline constexpr detail::Task<bool> kReadsItself{"reads_itself"};     ///< asks for another task

}  // namespace stylet::test
