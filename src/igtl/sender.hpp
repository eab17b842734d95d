// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hub.hpp"
#include "stylet/realtime/latest_value.hpp"

#include <boost/asio/steady_timer.hpp>

#include <mutex>
#include <optional>

namespace stylet::igtl {

/// Encodes pictures as messages and sends them, on a timer in the link's thread.
class Sender {
 public:
  Sender(boost::asio::io_context& io, const LinkSettings& settings, Hub& hub)
      : settings_(settings), hub_(hub), timer_(io) {}

  void start();
  void stop() { timer_.cancel(); }

  /// Call it from one thread, the publishing thread.
  void publish(const Picture& picture) { picture_.write(picture); }
  /// May be called from any thread.
  void publish(Surface surface);
  /// May be called from any thread.
  void publish(GreyPicture image);

 private:
  using Clock = Connection::Clock;
  void wait();
  void turn(Clock::time_point now);
  void send_surface(Clock::time_point now);
  void send_image(Clock::time_point now);
  [[nodiscard]] Bytes poses(bool fresh) const;
  [[nodiscard]] Bytes heartbeat(bool fresh) const;

  const LinkSettings& settings_;
  Hub& hub_;
  boost::asio::steady_timer timer_;
  LatestValue<Picture> picture_;
  bool have_picture_ = false;
  Clock::time_point picture_time_;
  Clock::time_point surface_due_;
  Clock::time_point image_due_;
  Clock::time_point heartbeat_due_;
  std::mutex mutex_;
  std::optional<Surface> surface_;    ///< guarded by the mutex: the newest surface that has not been sent
  std::optional<GreyPicture> image_;  ///< guarded by the mutex: the newest image that has not been sent
};

}  // namespace stylet::igtl
