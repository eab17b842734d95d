// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/serve/server.hpp"

#include "access.hpp"
#include "complaints.hpp"
#include "door.hpp"
#include "hall.hpp"
#include "kept_token.hpp"
#include "pages.hpp"
#include "stylet/core/survive.hpp"

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <thread>

namespace stylet::serve {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

constexpr auto kRequestTime = std::chrono::seconds(20);
constexpr auto kRefusedTime = std::chrono::seconds(2);
constexpr std::size_t kRefused = 32;  ///< most connections at once that are told that there are too many
constexpr auto kAcceptAgain = std::chrono::milliseconds(200);
constexpr std::size_t kRequestBytes = 16 * 1024;
constexpr int kNiceReading = 10;  // lower priority than the loop and its recording; the reading program inherits it

}  // namespace

/// The connections: HTTP requests are answered, and those that become WebSockets are passed to the hall. Everything
/// here happens in the thread of `io`.
struct Server::Parts {
  Parts(ServerSettings settings_, Access access_)
      : settings(std::move(settings_)),
        complaints(settings.session.say),
        access(std::move(access_)),
        acceptor(io),
        retry(io),
        pages(access, Shelf(settings.session.recordings, settings.session.archive)),
        door(settings.connections, settings.connections_per_address),
        hall(io, settings.session, settings.hand_silence_s) {}

  ServerSettings settings;
  Complaints complaints;
  Access access;
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::steady_timer retry;
  Pages pages;
  Door door;
  Door refused_door{kRefused, kRefused};
  std::uint64_t last_id = 0;
  Hall hall;
  std::thread thread;
  asio::thread_pool readers{1};  ///< last member, so that it ends before the members that its work uses

  /// A connection that is not a viewer yet.
  struct Caller {
    beast::tcp_stream stream;
    std::shared_ptr<const void> pass;
    bool is_refused = false;  ///< it only hears that there are too many connections
  };

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return accept_later();
      survive(
          "a new connection",
          [&] {
            beast::error_code ignored;
            socket.set_option(tcp::no_delay(true), ignored);
            let_in(std::move(socket));
          },
          [this](const Error& why) { complaints.tell(why); });
      accept();
    });
  }
  void let_in(tcp::socket socket) {
    beast::error_code gone;
    const std::string address = socket.remote_endpoint(gone).address().to_string();
    auto pass = door.enter(address);
    const bool is_refused = pass == nullptr;
    if (is_refused) pass = refused_door.enter(address);
    if (pass)
      read_request(std::make_shared<Caller>(Caller{beast::tcp_stream(std::move(socket)), std::move(pass), is_refused}));
  }
  /// Does the work of `io` until it is stopped. An exception of a piece of work that does not survive by itself ends
  /// that piece, and at most the connection that it belongs to.
  void run() {
    const auto tell = [this](const Error& why) { complaints.tell(why); };
    while (!io.stopped())
      survive(
          "the connections", [this] { io.run(); }, tell);
  }
  /// Accepts again after a pause. Used after an error that would recur at once, such as too many open files.
  void accept_later() {
    retry.expires_after(kAcceptAgain);
    retry.async_wait([this](beast::error_code error) {
      if (!error) accept();
    });
  }
  struct Reading {
    beast::flat_buffer buffer{kRequestBytes};
    http::request_parser<http::string_body> parser;
  };
  void read_request(const std::shared_ptr<Caller>& caller) {
    auto reading = std::make_shared<Reading>();
    reading->parser.body_limit(kRequestBytes);
    caller->stream.expires_after(caller->is_refused ? kRefusedTime : kRequestTime);
    http::async_read(caller->stream, reading->buffer, reading->parser,
                     [this, caller, reading](beast::error_code error, std::size_t /*bytes*/) {
                       if (!error) answer(caller, reading->parser.get());
                     });
  }
  void answer(const std::shared_ptr<Caller>& caller, const HttpRequest& request) {
    if (caller->is_refused)
      return refuse(caller, request, "There are too many connections to this server. Close some of its pages first.");
    if (path_of(target(request)) == "/live" && pages.verdict(request) == Access::Verdict::granted) {
      if (hall.size() >= settings.viewers)
        return refuse(caller, request, "There are too many viewers already. Wait until one has closed the page.");
      if (beast::websocket::is_upgrade(request)) {
        std::make_shared<Viewer>(++last_id, std::move(caller->stream), std::move(caller->pass), hall,
                                 settings.silence_s)
            ->accept(request);
        return;
      }
    }
    // Reading a recording takes a while, so another thread does it; here all viewers would have to wait.
    caller->stream.expires_never();
    asio::post(readers, [this, caller, request] {
      const auto respond = [&](HttpResponse response) {
        asio::post(io, [this, caller, made = std::move(response)] { write(caller, made); });
      };
      survive(
          "a request to the server", [&] { respond(pages.answer(request)); },
          [&](const Error& why) {
            complaints.tell(why);
            respond(Pages::refusal(request, http::status::internal_server_error, why.message() + '.'));
          });
    });
  }
  void refuse(const std::shared_ptr<Caller>& caller, const HttpRequest& request, const std::string& why) {
    HttpResponse response = Pages::refusal(request, http::status::service_unavailable, why);
    response.keep_alive(false);
    write(caller, std::move(response));
  }
  void write(const std::shared_ptr<Caller>& caller, HttpResponse made) {
    auto response = std::make_shared<HttpResponse>(std::move(made));
    const bool again = response->keep_alive();
    caller->stream.expires_after(kRequestTime);
    http::async_write(caller->stream, *response,
                      [this, caller, response, again](beast::error_code error, std::size_t /*n*/) {
                        if (!error && again) return read_request(caller);
                        beast::error_code ignored;
                        caller->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }
};

namespace {

/// Makes the access rules from the settings. With a given token the server answers under any host name, so that a proxy
/// can forward requests to it.
Result<Access> access_for(const ServerSettings& settings, bool is_loopback) {
  const std::string& given = settings.token;
  if (!settings.asks_for_token) {
    if (is_loopback && given.empty()) return Access("");
    return input_error(
        "stylet serve",
        given.empty()
            ? fmt::format("without a token, everybody who can reach {} could move the needle", settings.address)
            : "--token and --no-token exclude each other",
        given.empty() ? "Leave --no-token out, or listen on 127.0.0.1" : "Give either --token or --no-token");
  }
  if (!given.empty() && !is_plain_token(given))
    return input_error("stylet serve",
                       fmt::format("the token '{}' has characters that a web address cannot hold", given),
                       "Use letters, digits and -._~ only");
  if (!given.empty()) return Access(given, Access::Names::any);
  return Access(kept_token(settings.token_file), is_loopback ? Access::Names::loopback : Access::Names::any);
}

}  // namespace

Result<std::unique_ptr<Server>> Server::open(ServerSettings settings) {
  const std::string where = fmt::format("stylet serve, {}:{}", settings.address, settings.port);
  if (settings.session.cases.empty() && settings.session.replay.empty())
    return input_error("stylet serve", "there is no case to open", "Name a scenario file");
  beast::error_code error;
  const auto address = asio::ip::make_address(settings.address, error);
  if (error)
    return input_error(where, fmt::format("'{}' is not an IP address", settings.address),
                       "Give an address such as 127.0.0.1 (this machine only) or 0.0.0.0 (all its networks)");
  auto access = access_for(settings, address.is_loopback());
  if (!access) return access.error();
  auto parts = std::make_unique<Parts>(std::move(settings), std::move(*access));
  const tcp::endpoint endpoint(address, parts->settings.port);
  const auto refused = [&](const char* what) {
    return failure(where, fmt::format("cannot {}: {}", what, error.message()),
                   "Choose another port with --port (0: any free port), or end the program that uses this one");
  };
  parts->acceptor.open(endpoint.protocol(), error);
  if (error) return refused("open a socket");
  parts->acceptor.set_option(asio::socket_base::reuse_address(true), error);
  parts->acceptor.bind(endpoint, error);
  if (error) return refused("listen at this address and port");
  parts->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return refused("listen at this address and port");
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Server::~Server() { stop(); }

std::uint16_t Server::port() const {
  beast::error_code ignored;
  return parts_->acceptor.local_endpoint(ignored).port();
}

const std::string& Server::token() const { return parts_->access.token(); }

std::string Server::url() const {
  beast::error_code ignored;
  const auto address = parts_->acceptor.local_endpoint(ignored).address();
  const std::string host = address.is_loopback()      ? "localhost"
                           : address.is_unspecified() ? asio::ip::host_name(ignored)
                           : address.is_v6()          ? "[" + address.to_string() + "]"
                                                      : address.to_string();
  const std::string query = parts_->access.token().empty() ? "" : "?token=" + parts_->access.token();
  return fmt::format("http://{}:{}/{}", host, port(), query);
}

void Server::start() {
  Parts& p = *parts_;
  p.accept();
  p.hall.start();
  asio::post(p.readers, [] { (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceReading); });
  p.thread = std::thread([&p] { p.run(); });
  p.hall.session().start();
}

void Server::stop() {
  Parts& p = *parts_;
  if (!p.thread.joinable()) return;
  p.hall.session().stop();
  p.readers.join();
  asio::post(p.io, [&p] {
    beast::error_code ignored;
    p.acceptor.close(ignored);
    p.retry.cancel();
    p.hall.close();
    p.io.stop();
  });
  p.thread.join();
}

}  // namespace stylet::serve
