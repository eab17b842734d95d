// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet::results {

/// A region's name inside a sentence: "pubic arch".
std::string spoken_name(const std::string& region);

/// Says the events of one needle in words, in the order in which they happened: command line, report, reproduction and
/// live page have them from here. An event names the region that the tip comes to; the region that it leaves follows
/// from the events before it.
class EventWords {
 public:
  /// Takes up the next event. @return what the tip did, without a subject: "went through the skin", "entered the
  /// prostate", "left the prostate into the bladder". Empty for a region that was entered by the puncture before: both
  /// are one crossing, which has been said.
  std::string clause(const Event& event);
  /// The same with a capital letter, as a label.
  std::string label(const Event& event);

 private:
  /// A track that an earlier insertion of the needle has left, which it may follow again without an event.
  struct Track {
    std::string end;       ///< region of its end
    double length_mm = 0;  ///< from the first contact to the last crossing
  };

  [[nodiscard]] std::string left_by(const Event& event) const;
  std::string crossing(const Event& event);
  void touch(const Event& event);

  std::optional<std::string> where_;  ///< region of the end of the track, "" outside; empty: not known
  std::string touched_;               ///< region of the last contact from outside
  double touched_mm_ = 0;             ///< depth of the base then
  double crossed_mm_ = 0;             ///< depth of the base at the last crossing
  std::optional<Track> earlier_;
  std::optional<Event> puncture_;  ///< the event before, if it was a puncture
};

/// The labels of a needle's events, from its first one on; empty as EventWords::clause().
std::vector<std::string> event_labels(std::span<const Event> events);

}  // namespace stylet::results
