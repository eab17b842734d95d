// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "message_reader.hpp"
#include "message_writer.hpp"

#include <boost/asio/ip/tcp.hpp>

#include <chrono>
#include <memory>
#include <optional>

namespace stylet::igtl {

/// One connection, used in the link's thread only. Of each kind of content only the newest message waits to be sent, so
/// a slow receiver takes little memory and gets the newest state. All connections share the bytes of a message.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using Clock = std::chrono::steady_clock;
  using Shared = std::shared_ptr<const Bytes>;
  enum Content { answers, status, poses, surface, image, kContents };

  struct Events {
    std::function<void(const Incoming&)> message;
    /// Called once; no event follows. @param why what was wrong with the received bytes; empty: nothing was wrong
    std::function<void(const std::optional<Refusal>& why)> closed;
  };

  /// @param checksums whether the received bodies have to match their checksums
  Connection(Socket socket, Events events, bool checksums);
  void start();  ///< starts reading
  /// Queues a message. @return false if it replaced a waiting message of the same content
  bool offer(Content content, Shared bytes);
  /// Queues the answer to a command behind those that are waiting. @return false if too many bytes are waiting
  bool answer(const Bytes& bytes);
  /// Closes the connection and calls Events::closed; does nothing if it is closed already.
  void close(const std::optional<Refusal>& why = {});
  /// Whether data are being sent. @param start set to the time at which this send started
  [[nodiscard]] bool sending_since(Clock::time_point& start) const;
  /// Address and port of the other program.
  [[nodiscard]] const std::string& peer() const { return peer_; }

 private:
  void read();
  void send();

  Socket socket_;
  std::string peer_;
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
