// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_display.hpp"

#include "stylet/core/printable.hpp"
#include "stylet/core/survive.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace stylet::cli {

namespace {

using namespace std::chrono_literals;

constexpr auto kSilence = 1s;  ///< work that takes less time shows no progress
constexpr auto kRedrawEvery = 100ms;
constexpr auto kLineEvery = 10s;  ///< time between plain lines within a stage
constexpr int kStageWidth = 30;

/// Prints to standard error. Errors are ignored, because work can continue without this output.
void print(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool terminal, const std::string& first)
    : terminal_(terminal), first_(printable_lines(first)), thread_([this] { run(); }) {}

ProgressDisplay::~ProgressDisplay() {
  {
    const std::scoped_lock lock(mutex_);
    finished_ = true;
    clear_bar();
  }
  wake_.notify_one();
  thread_.join();
}

void ProgressDisplay::update(std::string_view stage, double fraction) {
  const std::scoped_lock lock(mutex_);
  stage_ = printable_name(stage);
  fraction_ = std::clamp(fraction, 0.0, 1.0);
}

void ProgressDisplay::interrupt(const std::function<void()>& print) {
  const std::scoped_lock lock(mutex_);
  clear_bar();
  print();
}

void ProgressDisplay::run() {
  std::unique_lock lock(mutex_);
  auto pause = std::chrono::duration_cast<Clock::duration>(kSilence);
  while (!wake_.wait_for(lock, pause, [this] { return finished_; })) {
    pause = kRedrawEvery;
    survive(
        "the display of progress", [this] { show(); }, [](const Error&) {});
  }
}

void ProgressDisplay::show() {
  if (stage_.empty()) return;
  if (!first_.empty()) print(std::exchange(first_, {}) + "\n");
  if (terminal_) {
    draw_bar();
  } else if (stage_ != announced_) {
    print(stage_ + " ...\n");
    announced_ = stage_;
    last_line_ = Clock::now();
  } else if (Clock::now() - last_line_ >= kLineEvery) {
    print(fmt::format("{}: {:.0f} %\n", stage_, 100 * fraction_));
    last_line_ = Clock::now();
  }
}

void ProgressDisplay::draw_bar() {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::string numbers = fmt::format(" {:3.0f} % {:5.0f} s", 100 * fraction_, seconds);
  const int width = std::clamp(terminal_width() - kStageWidth - static_cast<int>(numbers.size()) - 4, 0, 50);
  const int full = static_cast<int>(fraction_ * width);
  print(fmt::format("\r{:<{}.{}} [{:#<{}}{:.<{}}]{}\x1b[K", stage_, kStageWidth, kStageWidth, "", full, "",
                    width - full, numbers));
  bar_visible_ = true;
}

void ProgressDisplay::clear_bar() {
  if (!bar_visible_) return;
  print("\r\x1b[K");
  bar_visible_ = false;
}

}  // namespace stylet::cli
