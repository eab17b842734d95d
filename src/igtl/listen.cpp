// SPDX-License-Identifier: GPL-3.0-or-later
#include "own_process.hpp"
#include "stylet/core/survive.hpp"
#include "transport.hpp"

#include <fmt/format.h>

namespace stylet::igtl {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

class Listener final : public Transport {
 public:
  Listener(tcp::acceptor acceptor, asio::io_context& io, const LinkSettings& settings, Hub& hub)
      : acceptor_(std::move(acceptor)), settings_(settings), pause_(io), hub_(hub) {}

  void start() override {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (error) return rest(error.message());
      const bool is_known = settings_.trust_own_processes && is_own_process(socket);
      const Hub::Trust trust = is_known ? Hub::Trust::known : Hub::Trust::stranger;
      if (const std::string why_not = hub_.why_not(trust); !why_not.empty()) {
        hub_.turn_away(why_not);  // the socket closes here
      } else {
        survive(
            "a new OpenIGTLink connection", [&] { hub_.add(std::move(socket), {}, trust); },
            [this](const Error& why) { hub_.set_problem(why.what); });
      }
      start();
    });
  }
  void stop() override {
    error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
  }

 private:
  /// Accepts again after a pause. After an error such as too many open files, an immediate retry would loop.
  void rest(const std::string& problem) {
    hub_.set_problem("accepting a connection: " + problem);
    pause_.expires_after(std::chrono::milliseconds(200));
    pause_.async_wait([this](const error_code& error) {
      if (!error && acceptor_.is_open()) start();
    });
  }

  tcp::acceptor acceptor_;
  const LinkSettings& settings_;
  asio::steady_timer pause_;
  Hub& hub_;
};

}  // namespace

Result<std::unique_ptr<Transport>> listen(asio::io_context& io, const LinkSettings& settings, Hub& hub) {
  auto endpoints = look_up(io, settings);
  if (!endpoints) return endpoints.error();
  const tcp::endpoint at = endpoints->front();
  tcp::acceptor acceptor(io);
  error_code error;
  acceptor.open(at.protocol(), error);
  // Without this option the port stays in use for a minute after the last connection.
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(at, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    const std::string where = fmt::format("OpenIGTLink, {} port {}", settings.host, settings.port);
    if (error == asio::error::address_in_use)
      return failure(where, "another program uses this port", "End that program, or give another port");
    return failure(where, error.message(), "Give an address of this machine and a port that you may open");
  }
  hub.set_port(acceptor.local_endpoint(error).port());
  return std::unique_ptr<Transport>(std::make_unique<Listener>(std::move(acceptor), io, settings, hub));
}

}  // namespace stylet::igtl
