// SPDX-License-Identifier: GPL-3.0-or-later
#include "connection.hpp"

#include "stylet/core/survive.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

#include <sstream>

namespace stylet::igtl {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

/// Sends small messages without delay, limits the kernel's send buffer so that a slow receiver gets no outdated data,
/// and detects a machine that has disappeared without closing its connection.
void set_options(Connection::Socket& socket) {
  using Timeout = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_USER_TIMEOUT>;
  constexpr int timeout_ms = 10'000;
  constexpr int send_bytes = 1 << 18;
  error_code ignored;
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(send_bytes), ignored);
  socket.set_option(Timeout(timeout_ms), ignored);
}

std::string peer_of(const Connection::Socket& socket) {
  error_code error;
  const auto peer = socket.remote_endpoint(error);
  if (error) return "an unknown address";
  std::ostringstream text;
  text << peer;
  return text.str();
}

}  // namespace

Connection::Connection(Socket socket, Events events, bool checksums)
    : socket_(std::move(socket)),
      peer_(peer_of(socket_)),
      events_(std::move(events)),
      reader_({.checksums = checksums}) {
  set_options(socket_);
}

void Connection::start() { read(); }

void Connection::read() {
  socket_.async_read_some(asio::buffer(room_), [self = shared_from_this()](const error_code& error, std::size_t n) {
    if (self->closed_) return;
    if (error && !self->reader_.is_inside()) return self->close();
    if (error)
      return self->close(Refusal{"cut", "it ended inside a message",
                                 "Let the other program send whole messages before it disconnects"});
    Result<> ok = Ok{};
    survive(
        "an OpenIGTLink message",
        [&] { ok = self->reader_.take(std::span(self->room_).first(n), self->events_.message); },
        [&](const Error& why) { ok = failure(why.where, "something at which this program failed", why.cure); });
    if (!ok) return self->close(Refusal{"no message", "it sent " + ok.error().what, ok.error().cure});
    self->read();
  });
}

bool Connection::offer(Content content, Shared bytes) {
  if (closed_) return true;
  Shared& place = waiting_.at(content);
  const bool free = place == nullptr;
  place = std::move(bytes);
  send();
  return free;
}

bool Connection::answer(const Bytes& bytes) {
  constexpr std::size_t most = 65536;
  const Shared& before = waiting_.at(answers);
  Bytes all = before ? *before : Bytes{};
  if (all.size() + bytes.size() > most) return false;
  all.insert(all.end(), bytes.begin(), bytes.end());
  offer(answers, std::make_shared<const Bytes>(std::move(all)));
  return true;
}

void Connection::send() {
  if (sending_ || closed_) return;
  std::vector<asio::const_buffer> buffers;
  for (std::size_t k = 0; k < kContents; ++k) {
    under_way_[k] = std::move(waiting_[k]);
    waiting_[k] = nullptr;
    if (under_way_[k]) buffers.push_back(asio::buffer(*under_way_[k]));
  }
  if (buffers.empty()) return;
  sending_ = true;
  sending_start_ = Clock::now();
  asio::async_write(socket_, buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
    self->sending_ = false;
    self->under_way_ = {};
    if (self->closed_) return;
    if (error) return self->close();
    self->send();
  });
}

void Connection::close(const std::optional<Refusal>& why) {
  if (closed_) return;
  closed_ = true;
  waiting_ = {};
  error_code ignored;
  socket_.shutdown(Socket::shutdown_both, ignored);
  socket_.close(ignored);
  events_.closed(why);
}

bool Connection::sending_since(Clock::time_point& start) const {
  if (sending_) start = sending_start_;
  return sending_;
}

}  // namespace stylet::igtl
