// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "http.hpp"
#include "outbox.hpp"

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <chrono>
#include <memory>

namespace stylet::serve {

class Viewer;

/// Receives the messages of viewers; implemented by the server.
class ViewerDesk {
 public:
  virtual ~ViewerDesk() = default;
  virtual void arrived(const std::shared_ptr<Viewer>& viewer) = 0;
  virtual void left(std::uint64_t id) = 0;
  virtual void heard(Viewer& viewer, const HandTarget& hand) = 0;
  virtual void heard(Viewer& viewer, const Command& command) = 0;
  virtual void heard(Viewer& viewer, const wire::Seen& seen) = 0;
};

/// The connection to one page, over a WebSocket. Everything happens in the server's thread.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  /// @param pass counts as an open connection as long as the viewer lives (Door)
  /// @param silence_s [s] a page that has neither sent a message nor answered a ping for this time is disconnected
  Viewer(std::uint64_t id, boost::beast::tcp_stream stream, std::shared_ptr<const void> pass, ViewerDesk& desk,
         double silence_s);
  void accept(const HttpRequest& request);
  void close();

  void send(const Parcel& parcel);
  void send(const std::shared_ptr<const LiveFrame>& frame);

  [[nodiscard]] std::uint64_t id() const { return id_; }
  [[nodiscard]] std::int64_t dropped_messages() const { return dropped_; }
  [[nodiscard]] std::int64_t skipped_frames() const { return outbox_.skipped_frames(); }
  [[nodiscard]] std::optional<double> lag_s() const { return outbox_.lag_s(); }

 private:
  void read();
  void hear(std::span<const std::byte> message);
  void write();
  void end();

  std::uint64_t id_;
  std::shared_ptr<const void> pass_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  ViewerDesk& desk_;
  std::chrono::steady_clock::duration silence_;
  boost::beast::flat_buffer incoming_;
  bool open_ = false;
  bool ended_ = false;
  std::int64_t dropped_ = 0;
  Allowance allowance_;
  Outbox outbox_;
  wire::Bytes outgoing_;  ///< the message that is being written
  bool writing_ = false;
};

}  // namespace stylet::serve
