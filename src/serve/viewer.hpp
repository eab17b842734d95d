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

/// Receives the messages of viewers; implemented by the server.
class ViewerDesk {
 public:
  virtual ~ViewerDesk() = default;
  virtual void arrived(const std::shared_ptr<Viewer>& viewer) = 0;
  virtual void left(std::uint64_t id) = 0;
  virtual void heard(Viewer& viewer, const HandTarget& hand) = 0;
  virtual void heard(Viewer& viewer, const wire::Command& command) = 0;
};

/// The connection to one page, over a WebSocket. Everything happens in the server's thread. Messages to the page wait
/// in a queue; of pictures and states only the newest waits.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  /// @param silence_s [s] a page that has neither sent a message nor answered a ping for this time is disconnected
  Viewer(std::uint64_t id, boost::beast::tcp_stream stream, ViewerDesk& desk, double silence_s);
  void accept(const HttpRequest& request);
  void close();

  void send(std::shared_ptr<const Scene> scene);
  void send(std::shared_ptr<const LiveFrame> frame);
  void send(std::shared_ptr<const LiveDose> dose);
  void send(std::shared_ptr<const LiveImage> image);
  /// @param kind a kind with JSON, except status; of maps, plans, implants and places of seeds only the newest waits
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
  double allowance_;  ///< number of messages that the page may send at this moment; refills with time
  std::chrono::steady_clock::time_point last_message_;

  struct Waiting {
    wire::Kind kind{};
    std::shared_ptr<const Scene> scene;
    std::string json;
    std::shared_ptr<const LiveDose> dose{};
    std::shared_ptr<const LiveImage> image{};
  };
  std::deque<Waiting> waiting_;
  std::optional<std::string> status_;
  std::shared_ptr<const LiveFrame> frame_;
  std::vector<Step> curve_;   ///< samples that have not been sent
  bool whole_curve_ = false;  ///< curve_ starts at the beginning of the insertion
  std::int64_t skipped_ = 0;
  std::uint32_t sent_ = 0;
  wire::Bytes outgoing_;  ///< the message that is being written
  bool writing_ = false;
};

}  // namespace stylet::serve
