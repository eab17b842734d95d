// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/moments.hpp"
#include "stylet/io/recording_io.hpp"

#include <array>
#include <string>
#include <vector>

/// The run in words: every sentence is made from the recorded numbers. Plain text, not yet HTML.
namespace stylet::results {

/// What happened, for a reader who has never seen a force curve: a few sentences each.
/// @param run has at least one frame and a summary
std::vector<std::string> tell_what_happened(const RunRecording& run, const Moments& moments);

/// How fast it was computed, one or two sentences.
std::string tell_step_times(const Summary& summary);

/// "Prostate punctured", "Retraction starts": an event in a few words.
std::string event_label(const Event& event);

/// A displacement in patient directions, "2.7 mm towards the head and 0.5 mm forwards".
/// @param shift [mm] LPS
std::string describe_shift(const Vec3& shift);

/// What a component is called where it is positive, and where it is negative.
struct DirectionWords {
  const char* positive;
  const char* negative;
};
/// A displacement component by component, the largest first; what rounds to nothing is left out.
/// @param shift [mm] LPS @param digits after the point
std::string in_words(const Vec3& shift, const std::array<DirectionWords, 3>& words, int digits);

/// The target's regions in a sentence, "peripheral zone and transition zone".
std::string target_name(const RunRecording& run);

}  // namespace stylet::results
