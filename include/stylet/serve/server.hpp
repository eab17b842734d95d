// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/serve/session.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace stylet::serve {

struct ServerSettings {
  std::string address = "127.0.0.1";  ///< to listen on
  std::uint16_t port = 8080;          ///< 0: any that is free
  std::string token;                  ///< that viewers must know; empty: one is made
  bool asks_for_token = true;         ///< false: everybody of this machine may come in; on the loopback interface only
  std::filesystem::path
      token_file;            ///< keeps the made token of the loopback interface for the next start; may be empty
  std::size_t viewers = 32;  ///< at most
  double silence_s = 15.0;   ///< a viewer who has not answered for so long is gone
  SessionSettings session;
};

/// The live page: HTTP, WebSockets (docs/live_protocol.md) and the session behind them. One thread serves all viewers;
/// each has room for one picture, so a slow one loses pictures and delays nobody.
class Server {
 public:
  /// Listens. Errors: an address that is none, a port that is taken, a token that cannot stand in an address, or none
  /// asked for beyond the loopback interface.
  static Result<std::unique_ptr<Server>> open(ServerSettings settings);
  ~Server();  ///< stop()
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// What to open in a browser, with the token if one is asked for.
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
