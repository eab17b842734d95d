// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/serve/session_settings.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace stylet::serve {

struct ServerSettings {
  std::string address = "127.0.0.1";  ///< IP address to listen on
  std::uint16_t port = 8080;          ///< 0: any free port
  std::string token;  ///< secret word in the address that lets viewers in; empty: a random token is made
  /// False lets every user of this machine in without a token; allowed on the loopback interface only.
  bool asks_for_token = true;
  /// File that keeps the random token for the next start; empty: each start has a new one.
  std::filesystem::path token_file;
  std::size_t viewers = 32;                  ///< largest number of viewers
  std::size_t connections = 256;             ///< largest number of open connections, viewers included
  std::size_t connections_per_address = 64;  ///< the same from one IP address
  double silence_s = 15.0;                   ///< [s] a viewer that has not answered for this time is disconnected
  double hand_silence_s = 0.8;               ///< [s] the needle stops when its holder has said nothing for this time
  SessionSettings session;
};

/// The server of the live page: HTTP, WebSockets (docs/live_protocol.md) and the session behind them. One thread serves
/// all viewers. For each viewer at most one picture waits to be sent, so a slow viewer misses pictures and delays no
/// other viewer. The connection one too many is told so (HTTP 503).
class Server {
 public:
  /// Opens the port. Errors: an invalid IP address, a port in use, a token with characters that a URL cannot hold, or
  /// asks_for_token = false on an address other than the loopback interface.
  static Result<std::unique_ptr<Server>> open(ServerSettings settings);
  ~Server();  ///< stop()
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The address to open in a browser, with the token if there is one.
  [[nodiscard]] std::string url() const;
  /// The token; empty where none is asked for.
  [[nodiscard]] const std::string& token() const;
  [[nodiscard]] std::uint16_t port() const;

  /// Starts serving, in threads of its own.
  void start();
  /// Ends the session, completes its recording and closes all connections. May be called from any thread.
  void stop();

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::serve
