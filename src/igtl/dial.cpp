// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/survive.hpp"
#include "transport.hpp"

#include <boost/asio/connect.hpp>

#include <algorithm>

namespace stylet::igtl {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

class Dialer final : public Transport {
 public:
  Dialer(asio::io_context& io, Endpoints endpoints, const LinkSettings& settings, Hub& hub)
      : io_(io), endpoints_(std::move(endpoints)), settings_(settings), hub_(hub), timer_(io), socket_(io) {}

  void start() override {
    pause_s_ = settings_.retry_s;
    connect();
  }
  void stop() override {
    stopped_ = true;
    timer_.cancel();
    error_code ignored;
    socket_.close(ignored);
  }

 private:
  void connect() {
    socket_ = tcp::socket(io_);
    // A machine that is switched off does not answer for minutes; closing the socket ends the attempt.
    timer_.expires_after(std::chrono::seconds(5));
    timer_.async_wait([this](const error_code& error) {
      if (error || stopped_) return;
      error_code ignored;
      socket_.close(ignored);
    });
    asio::async_connect(socket_, endpoints_, [this](const error_code& error, const tcp::endpoint&) {
      timer_.cancel();
      if (stopped_) return;
      if (error) {
        hub_.set_problem("connecting: " + error.message());
        return retry();
      }
      if (to_itself()) return retry();
      pause_s_ = settings_.retry_s;
      survive(
          "a new OpenIGTLink connection", [this] { hub_.add(std::move(socket_), [this] { retry(); }); },
          [this](const Error& why) {
            hub_.set_problem(why.what);
            retry();
          });
    });
  }

  /// Whether the socket is connected to itself. If no program listens on this machine, the kernel may choose the remote
  /// port as the local port as well.
  [[nodiscard]] bool to_itself() const {
    error_code error;
    const auto local = socket_.local_endpoint(error);
    return !error && local == socket_.remote_endpoint(error) && !error;
  }

  void retry() {
    if (stopped_) return;
    error_code ignored;
    socket_.close(ignored);
    timer_.expires_after(
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(pause_s_)));
    pause_s_ = std::min(2.0 * pause_s_, settings_.longest_retry_s);
    timer_.async_wait([this](const error_code& error) {
      if (!error && !stopped_) connect();
    });
  }

  asio::io_context& io_;
  Endpoints endpoints_;
  const LinkSettings& settings_;
  Hub& hub_;
  asio::steady_timer timer_;
  tcp::socket socket_;
  double pause_s_ = 0.0;
  bool stopped_ = false;
};

}  // namespace

Result<std::unique_ptr<Transport>> dial(asio::io_context& io, const LinkSettings& settings, Hub& hub) {
  auto endpoints = look_up(io, settings);
  if (!endpoints) return endpoints.error();
  hub.set_port(settings.port);
  return std::unique_ptr<Transport>(std::make_unique<Dialer>(io, std::move(*endpoints), settings, hub));
}

}  // namespace stylet::igtl
