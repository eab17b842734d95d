// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "http.hpp"
#include "wire.hpp"

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <chrono>
#include <deque>
#include <memory>
#include <optional>

namespace stylet::serve {

class Viewer;

/// What a viewer's messages lead to.
class ViewerDesk {
 public:
  virtual ~ViewerDesk() = default;
  virtual void arrived(const std::shared_ptr<Viewer>& viewer) = 0;
  virtual void left(std::uint64_t id) = 0;
  virtual void heard(Viewer& viewer, const HandTarget& hand) = 0;
  virtual void heard(Viewer& viewer, const wire::Command& command) = 0;
};

/// A WebSocket with a page behind it. Everything happens in the server's thread. What a page has to get waits in a
/// queue, of pictures and states only the newest.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  /// @param silence_s a page that has neither said anything nor answered a ping for so long is gone [s]
  Viewer(std::uint64_t id, boost::beast::tcp_stream stream, ViewerDesk& desk, double silence_s);
  void accept(const HttpRequest& request);
  void close();

  void send(std::shared_ptr<const Scene> scene);
  void send(std::shared_ptr<const LiveFrame> frame);
  /// @param kind event, notice or map; of a map only the newest waits
  void send(wire::Kind kind, std::string json);
  void send_status(std::string json);

  [[nodiscard]] std::uint64_t id() const { return id_; }
  [[nodiscard]] std::int64_t dropped_messages() const { return dropped_; }
  [[nodiscard]] std::int64_t skipped_frames() const { return skipped_; }

 private:
  void read();
  void hear(std::span<const std::byte> message);
  [[nodiscard]] bool too_many();
  void write();
  bool next_message();
  void end();

  std::uint64_t id_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  ViewerDesk& desk_;
  std::chrono::steady_clock::duration silence_;
  boost::beast::flat_buffer incoming_;
  bool open_ = false;
  bool ended_ = false;
  std::int64_t dropped_ = 0;
  double allowance_;  ///< messages that may come now
  std::chrono::steady_clock::time_point last_message_;

  struct Waiting {
    wire::Kind kind{};
    std::shared_ptr<const Scene> scene;
    std::string json;
  };
  std::deque<Waiting> waiting_;
  std::optional<std::string> status_;
  std::shared_ptr<const LiveFrame> frame_;
  std::vector<Step> curve_;   ///< not sent yet
  bool whole_curve_ = false;  ///< they are all
  std::int64_t skipped_ = 0;
  std::uint32_t sent_ = 0;
  wire::Bytes outgoing_;  ///< while it is written
  bool writing_ = false;
};

}  // namespace stylet::serve
