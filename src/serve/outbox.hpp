// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "messages.hpp"

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

namespace stylet::serve {

/// The messages that wait for one connection. Of pictures of the needle, of states, and of all messages but scenes,
/// events and notices, only the newest waits. Pictures and other messages that come many times a second are fleeting:
/// a fleeting message is not sent while the page has yet to say that it has taken up 16 kB of earlier ones. So what is
/// under way, in whichever buffers, is at most this and one message more, and its age is bounded on any connection.
/// A page that gets its pictures late is sent smaller ones, with a coarser displacement.
class Outbox {
 public:
  static constexpr std::size_t kMostUnseen = 16 * 1024;  ///< [bytes]

  /// @return false if the page does not read its messages, so that too many wait
  bool put(const Parcel& parcel);
  /// @param now_s [s] wall-clock time
  void put(const std::shared_ptr<const LiveFrame>& frame, double now_s);
  /// The next message with its number; empty if nothing waits that may be sent.
  [[nodiscard]] std::optional<wire::Bytes> next();
  /// Takes note that the page has taken up all messages up to one.
  /// @param now_s [s] wall-clock time
  void seen(wire::Seen newest, double now_s);
  /// Age [s] of the last picture of the needle when the page had said that it has it; empty before the first.
  [[nodiscard]] std::optional<double> lag_s() const { return lag_s_; }
  /// Number of pictures that were replaced before they were sent.
  [[nodiscard]] std::int64_t skipped_frames() const { return skipped_; }

 private:
  wire::Bytes packed(const Parcel& parcel);
  wire::Bytes packed_frame();

  /// A fleeting message that the page has not said it has.
  struct Unseen {
    std::uint32_t number = 0;
    std::size_t bytes = 0;
    std::optional<double> since_s{};  ///< [s] wall-clock time at which a picture of the needle was put in
  };

  std::deque<Parcel> waiting_;
  std::optional<Parcel> status_;
  std::shared_ptr<const LiveFrame> frame_;
  double frame_since_s_ = 0.0;
  std::vector<Step> curve_;   ///< samples that have not been sent
  bool whole_curve_ = false;  ///< curve_ starts at the beginning of the insertion
  bool frame_was_last_ = false;
  std::deque<Unseen> unseen_;
  std::size_t unseen_bytes_ = 0;
  std::optional<double> lag_s_;
  std::int64_t skipped_ = 0;
  std::uint32_t sent_ = 0;
};

/// Limits how many messages a page may send: the allowance refills with time.
class Allowance {
 public:
  /// Takes one message. @return false: there were too many
  bool take();

 private:
  static constexpr double kPerSecond = 400.0;
  double left_ = kPerSecond;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace stylet::serve
