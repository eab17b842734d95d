// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/serve/session.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace stylet::serve {

struct ServerSettings {
  std::string address = "127.0.0.1";  ///< to listen on; anything but the loopback interface needs a token
  std::uint16_t port = 8080;          ///< 0: any that is free
  std::string token;                  ///< empty: one is made where it is needed
  std::size_t viewers = 32;           ///< at most
  SessionSettings session;
};

/// The live page: HTTP, WebSockets (docs/live_protocol.md) and the session behind them. One thread serves all viewers;
/// each has room for one picture, so a slow one loses pictures and delays nobody.
class Server {
 public:
  /// Listens. Errors: an address that is none, a port that is taken, settings out of range.
  static Result<std::unique_ptr<Server>> open(ServerSettings settings);
  ~Server();  ///< stop()
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// What to open in a browser, with the token if it needs one.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const;

  /// Begins to serve, in threads of its own.
  void start();
  /// Ends the session, whose recording is whole then, and closes all connections. Any thread.
  void stop();

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::serve
