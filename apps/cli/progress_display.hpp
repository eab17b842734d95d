// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace stylet::cli {

/// Shows on standard error how far long work has come: on a terminal a bar that redraws itself, elsewhere a line when a
/// stage begins and every ten seconds. Silent in the first second.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(bool terminal) : terminal_(terminal) {}

  /// @param fraction done of the stage, 0…1
  void update(std::string_view stage, double fraction);
  /// Takes the bar off the terminal, so that a line can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void draw_bar(double fraction);

  bool terminal_;
  bool visible_ = false;
  std::string stage_;
  std::string announced_;  ///< stage whose beginning has been printed as a line
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace stylet::cli
