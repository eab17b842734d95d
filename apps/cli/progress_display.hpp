// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace stylet::cli {

/// Shows on standard error, as long as it lives, how far long work has come: on a terminal a bar that redraws itself,
/// elsewhere a line when a stage begins and every ten seconds. Silent in the first second. A thread of its own keeps it
/// going through stages that report nothing for a while.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(bool terminal);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// @param fraction done of the stage, 0…1
  void update(std::string_view stage, double fraction);
  /// Prints something else, with the bar out of the way.
  void interrupt(const std::function<void()>& print);

 private:
  using Clock = std::chrono::steady_clock;
  void run();  ///< the thread
  void show();
  void draw_bar();
  void clear_bar();

  const bool terminal_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;  ///< guards all below
  std::string stage_;
  double fraction_ = 0;
  bool bar_visible_ = false;
  std::string announced_;  ///< stage whose beginning has been printed as a line
  Clock::time_point last_line_;
  bool finished_ = false;
  std::condition_variable wake_;
  std::thread thread_;
};

}  // namespace stylet::cli
