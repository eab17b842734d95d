// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/serve/picture.hpp"

#include <cstdint>
#include <vector>

namespace stylet::serve {

/// Decides which pictures of a live needle are passed on: those that differ visibly from the last one that was, and
/// otherwise some a second as a sign that nothing has happened. What is compared is what was passed on, so a slow drift
/// is seen as soon as it adds up to something visible.
class FrameNews {
 public:
  static constexpr double kSignEvery_s = 0.15;
  /// News are followed by so many more pictures, so that a page soon sees the same depth twice when the needle stands.
  static constexpr int kMoreAfterNews = 2;

  /// Says that there is a state of which pages have not been told.
  void owe() { is_owed_ = true; }
  [[nodiscard]] bool is_owed() const { return is_owed_; }

  enum class Verdict { nothing, sign_of_life, news };
  /// @param frame without its displacement
  /// @param is_news it is news whatever it shows
  /// @param now_s [s] wall-clock time
  Verdict judge(const LiveFrame& frame, bool is_news, double now_s);

 private:
  std::vector<std::uint32_t> words_;  ///< of the last news
  std::vector<float> numbers_;        ///< of the last news, in units of the smallest visible change
  bool is_owed_ = false;
  int more_ = 0;
  double passed_s_ = -1.0;
};

}  // namespace stylet::serve
