// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_display.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace stylet::cli {

namespace {

using namespace std::chrono_literals;

constexpr auto kSilence = 1s;        ///< shorter work shows nothing
constexpr auto kRedrawEvery = 50ms;  ///< bar
constexpr auto kReportEvery = 10s;   ///< plain lines
constexpr int kStageWidth = 30;

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

void ProgressDisplay::update(std::string_view stage, double fraction) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto now = Clock::now();
  const bool new_stage = stage != stage_;
  if (new_stage) stage_ = stage;
  if (now - start_ < kSilence) return;

  if (terminal_) {
    if (!new_stage && fraction < 1.0 && now - last_ < kRedrawEvery) return;
    draw_bar(fraction);
  } else {
    if (stage_ != announced_) {
      announced_ = stage_;
      fmt::print(stderr, "{} ...\n", stage_);
    } else if (now - last_ >= kReportEvery) {
      fmt::print(stderr, "{}: {:.0f} %\n", stage_, 100 * fraction);
    } else {
      return;
    }
  }
  last_ = now;
}

void ProgressDisplay::draw_bar(double fraction) {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::string numbers = fmt::format(" {:3.0f} % {:5.0f} s", 100 * fraction, seconds);
  const int width = std::clamp(terminal_width() - kStageWidth - static_cast<int>(numbers.size()) - 4, 0, 50);
  const int full = static_cast<int>(fraction * width);
  fmt::print(stderr, "\r{:<{}.{}} [{:#<{}}{:.<{}}]{}\x1b[K", stage_, kStageWidth, kStageWidth, "", full, "",
             width - full, numbers);
  std::fflush(stderr);
  visible_ = true;
}

void ProgressDisplay::clear() {
  if (!visible_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace stylet::cli
