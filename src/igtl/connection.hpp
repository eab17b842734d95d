// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "message_reader.hpp"
#include "message_writer.hpp"

#include <boost/asio/ip/tcp.hpp>

#include <chrono>
#include <memory>

namespace stylet::igtl {

/// One connection, in the link's thread. For each kind of content it keeps the newest that is not under way yet, so a
/// slow reader costs no memory and sees the newest; what is shared with other connections exists once.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using Clock = std::chrono::steady_clock;
  using Shared = std::shared_ptr<const Bytes>;
  enum Content { status, poses, surface, kContents };

  struct Events {
    std::function<void(const Incoming&)> message;
    /// Nothing comes from it afterwards. @param garbage what was wrong with its bytes; empty: it just ended
    std::function<void(const std::string& garbage)> closed;
  };

  Connection(Socket socket, Events events);
  void start();  ///< reading
  /// @return false when it took the place of something that was not sent
  bool offer(Content content, Shared bytes);
  /// Closes, and says so, unless it is closed.
  void close(const std::string& garbage = {});
  /// Since when a send has not come to its end.
  [[nodiscard]] bool sending_since(Clock::time_point& start) const;

 private:
  void read();
  void send();

  Socket socket_;
  Events events_;
  MessageReader reader_;
  std::array<std::uint8_t, 65536> room_{};
  std::array<Shared, kContents> waiting_;
  std::array<Shared, kContents> under_way_;
  bool sending_ = false;
  bool closed_ = false;
  Clock::time_point sending_start_;
};

}  // namespace stylet::igtl
