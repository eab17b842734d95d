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

/// Shows the progress of long work on standard error as long as it exists: on a terminal a bar that is redrawn,
/// elsewhere a line at the start of a stage and every ten seconds. It shows nothing in the first second. A thread of
/// its own updates it even if a stage reports nothing for a while.
class ProgressDisplay {
 public:
  /// @param first a sentence to print before the first progress; empty: none
  ProgressDisplay(bool terminal, const std::string& first);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Reports progress. @param fraction part of the stage that is done, 0…1
  void update(std::string_view stage, double fraction);
  /// Removes the bar and prints something else.
  void interrupt(const std::function<void()>& print);

 private:
  using Clock = std::chrono::steady_clock;
  void run();  ///< function of the thread
  void show();
  void draw_bar();
  void clear_bar();

  const bool terminal_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;  ///< guards the members below
  std::string first_;
  std::string stage_;
  double fraction_ = 0;
  bool bar_visible_ = false;
  std::string announced_;  ///< the last stage whose start was printed as a line
  Clock::time_point last_line_;
  bool finished_ = false;
  std::condition_variable wake_;
  std::thread thread_;
};

}  // namespace stylet::cli
