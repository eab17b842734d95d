// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/moment.hpp"
#include "stylet/io/recording_io.hpp"

namespace stylet {

/// The moment of a recording at a time, for pictures: displacement and needle are interpolated between the frames
/// before and after it, and the seeds move with the tissue. The forces are those of the nearer frame. Behind
/// a needle that has been drawn back, its track is shown. Before the first frame nothing has moved; after the last
/// one the result is the last frame.
Moment recorded_moment(const RunRecording& recording, double time_s);

/// The time of the recording's frame at which the needle is deepest [s]; 0 without a frame.
double deepest_time_s(const RunRecording& recording);

}  // namespace stylet
