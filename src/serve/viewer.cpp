// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer.hpp"

#include "messages.hpp"
#include "stylet/core/survive.hpp"
#include "wall_clock.hpp"

#include <boost/asio/buffer.hpp>

#include <variant>

namespace stylet::serve {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

namespace {

constexpr std::int64_t kMostDropped = 4000;  ///< after this many dropped messages the connection is closed

}  // namespace

Viewer::Viewer(std::uint64_t id, beast::tcp_stream stream, std::shared_ptr<const void> pass, ViewerDesk& desk,
               double silence_s)
    : id_(id),
      pass_(std::move(pass)),
      socket_(std::move(stream)),
      desk_(desk),
      silence_(
          std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(silence_s))) {}

void Viewer::accept(const HttpRequest& request) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has a timeout of its own
  auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
  timeout.idle_timeout = silence_;  // Beast sends a ping after half of it
  timeout.keep_alive_pings = true;
  socket_.set_option(timeout);
  socket_.set_option(websocket::stream_base::decorator(
      [](websocket::response_type& r) { r.set(beast::http::field::sec_websocket_protocol, wire::kSubprotocol); }));
  socket_.read_message_max(wire::kLongestMessage);
  socket_.binary(true);
  socket_.auto_fragment(false);
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return self->end();
    self->open_ = true;
    self->desk_.arrived(self);
    self->read();
    self->write();
  });
}

void Viewer::close() {
  if (ended_) return;
  beast::error_code ignored;
  beast::get_lowest_layer(socket_).socket().shutdown(boost::asio::ip::tcp::socket::shutdown_both, ignored);
  beast::get_lowest_layer(socket_).close();
  end();
}

void Viewer::end() {
  if (ended_) return;
  ended_ = true;
  open_ = false;
  desk_.left(id_);
}

void Viewer::read() {
  socket_.async_read(incoming_, [self = shared_from_this()](beast::error_code error, std::size_t /*bytes*/) {
    if (error) return self->end();
    const auto data = self->incoming_.cdata();
    survive(
        "a message of a page",
        [&] {
          self->hear({static_cast<const std::byte*>(data.data()), data.size()});
        },
        [&](const Error& why) { self->send(parcel_of(notice_of(why))); });
    self->incoming_.consume(self->incoming_.size());
    if (self->dropped_ > kMostDropped) return self->close();
    if (!self->ended_) self->read();
  });
}

void Viewer::hear(std::span<const std::byte> message) {
  const auto decoded = !allowance_.take() || !socket_.got_binary() ? std::nullopt : wire::decode(message);
  if (!decoded) {
    ++dropped_;
    return;
  }
  if (const auto* seen = std::get_if<wire::Seen>(&*decoded)) outbox_.seen(*seen, wall_clock_s());
  std::visit([this](const auto& what) { desk_.heard(*this, what); }, *decoded);
  write();
}

void Viewer::send(const Parcel& parcel) {
  if (!outbox_.put(parcel)) return close();
  write();
}

void Viewer::send(const std::shared_ptr<const LiveFrame>& frame) {
  outbox_.put(frame, wall_clock_s());
  write();
}

void Viewer::write() {
  if (!open_ || writing_) return;
  auto next = outbox_.next();
  if (!next) return;
  outgoing_ = std::move(*next);
  writing_ = true;
  socket_.async_write(boost::asio::buffer(outgoing_),
                      [self = shared_from_this()](beast::error_code error, std::size_t /*bytes*/) {
                        self->writing_ = false;
                        if (error) return self->end();
                        self->write();
                      });
}

}  // namespace stylet::serve
