// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer.hpp"

#include <boost/asio/buffer.hpp>

#include <algorithm>
#include <variant>

namespace stylet::serve {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

namespace {

constexpr double kMessagesPerSecond = 400.0;
constexpr std::int64_t kMostDropped = 4000;  ///< after this many dropped messages the connection is closed
constexpr std::size_t kMostWaiting = 2000;   ///< with this many waiting messages the connection is closed
constexpr std::size_t kMostSamples = 2000;   ///< most samples of the curve in a picture

}  // namespace

Viewer::Viewer(std::uint64_t id, beast::tcp_stream stream, ViewerDesk& desk, double silence_s)
    : id_(id),
      socket_(std::move(stream)),
      desk_(desk),
      silence_(
          std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(silence_s))),
      allowance_(kMessagesPerSecond),
      last_message_(std::chrono::steady_clock::now()) {}

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
    self->hear({static_cast<const std::byte*>(data.data()), data.size()});
    self->incoming_.consume(self->incoming_.size());
    if (self->dropped_ > kMostDropped) return self->close();
    if (!self->ended_) self->read();
  });
}

bool Viewer::too_many() {
  const auto now = std::chrono::steady_clock::now();
  const double dt = std::chrono::duration<double>(now - last_message_).count();
  last_message_ = now;
  allowance_ = std::min(kMessagesPerSecond, allowance_ + kMessagesPerSecond * dt);
  if (allowance_ < 1.0) return true;
  allowance_ -= 1.0;
  return false;
}

void Viewer::hear(std::span<const std::byte> message) {
  const auto decoded = too_many() || !socket_.got_binary() ? std::nullopt : wire::decode(message);
  if (!decoded) {
    ++dropped_;
    return;
  }
  std::visit([this](const auto& what) { desk_.heard(*this, what); }, *decoded);
}

void Viewer::send(std::shared_ptr<const Scene> scene) {
  frame_.reset();  // it belongs to the previous scene
  curve_.clear();
  waiting_.push_back({wire::Kind::scene, std::move(scene), {}, nullptr});
  write();
}

void Viewer::send(wire::Kind kind, std::string json) {
  if (kind != wire::Kind::event && kind != wire::Kind::notice)
    std::erase_if(waiting_, [kind](const Waiting& w) { return w.kind == kind; });
  if (waiting_.size() >= kMostWaiting) return close();  // the page does not read its messages
  waiting_.push_back({kind, nullptr, std::move(json), nullptr});
  write();
}

void Viewer::send(std::shared_ptr<const LiveDose> dose) {
  std::erase_if(waiting_, [](const Waiting& w) { return w.kind == wire::Kind::dose; });
  waiting_.push_back({wire::Kind::dose, nullptr, {}, std::move(dose)});
  write();
}

void Viewer::send(std::shared_ptr<const LiveImage> image) {
  std::erase_if(waiting_, [](const Waiting& w) { return w.kind == wire::Kind::image; });
  waiting_.push_back({wire::Kind::image, nullptr, {}, nullptr, std::move(image)});
  write();
}

void Viewer::send_status(std::string json) {
  status_ = std::move(json);
  write();
}

void Viewer::send(std::shared_ptr<const LiveFrame> frame) {
  if (frame_) ++skipped_;
  if ((frame->bits & LiveFrame::whole_curve) != 0) {
    curve_ = frame->curve;
    whole_curve_ = true;
  } else {
    curve_.insert(curve_.end(), frame->curve.begin(), frame->curve.end());
  }
  wire::thin(curve_, kMostSamples);
  frame_ = std::move(frame);
  write();
}

/// Encodes the next message into outgoing_. @return false if nothing waits
bool Viewer::next_message() {
  if (!waiting_.empty()) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    outgoing_ = next.scene   ? wire::encode(*next.scene, sent_++)
                : next.dose  ? wire::encode(*next.dose, sent_++)
                : next.image ? wire::encode(*next.image, sent_++)
                             : wire::encode(next.kind, next.json, sent_++);
    return true;
  }
  if (status_) {
    outgoing_ = wire::encode(wire::Kind::status, *status_, sent_++);
    status_.reset();
    return true;
  }
  if (!frame_) return false;
  outgoing_ = wire::encode(*frame_, curve_, whole_curve_, sent_++);
  frame_.reset();
  curve_.clear();
  whole_curve_ = false;
  return true;
}

void Viewer::write() {
  if (!open_ || writing_ || !next_message()) return;
  writing_ = true;
  socket_.async_write(boost::asio::buffer(outgoing_),
                      [self = shared_from_this()](beast::error_code error, std::size_t /*bytes*/) {
                        self->writing_ = false;
                        if (error) return self->end();
                        self->write();
                      });
}

}  // namespace stylet::serve
