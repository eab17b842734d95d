// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/moments.hpp"
#include "stylet/io/recording_io.hpp"

#include <array>
#include <string>
#include <vector>

/// Description of a run in sentences, all of which are generated from the recorded numbers. Plain text without HTML.
namespace stylet::results {

/// The course of the run, for a reader who has never seen a force curve; a few sentences in each paragraph.
/// @param run has at least one frame and a summary
std::vector<std::string> tell_what_happened(const RunRecording& run, const Moments& moments);

/// The computing times of the steps in one or two sentences.
std::string tell_step_times(const Summary& summary);

/// A displacement in patient directions, "2.7 mm towards the head and 0.5 mm forwards".
/// @param shift [mm] LPS
std::string describe_shift(const Vec3& shift);

/// Words for a component of a vector: for positive and for negative values.
struct DirectionWords {
  const char* positive;
  const char* negative;
};
/// A displacement in words, component by component, the largest first. Components that round to zero are left out.
/// @param shift [mm] LPS @param digits after the point
std::string in_words(const Vec3& shift, const std::array<DirectionWords, 3>& words, int digits);

/// The names of the target's regions for use in a sentence: "peripheral zone and transition zone".
std::string target_name(const RunRecording& run);

}  // namespace stylet::results
