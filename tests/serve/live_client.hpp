// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "wire.hpp"

#include <gtest/gtest.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <utility>

namespace stylet::test {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::asio::ip::tcp;

inline tcp::socket connected(boost::asio::io_context& io, std::uint16_t port) {
  tcp::socket socket(io);
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), port});
  return socket;
}

/// A GET, as a browser would send it.
inline http::response<http::string_body> get(std::uint16_t port, const std::string& target,
                                             const std::string& host = "localhost", const std::string& origin = {}) {
  boost::asio::io_context io;
  beast::tcp_stream stream(connected(io, port));
  http::request<http::string_body> request(http::verb::get, target, 11);
  request.set(http::field::host, host);
  if (!origin.empty()) request.set(http::field::origin, origin);
  http::write(stream, request);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(stream, buffer, response);
  return response;
}

/// A viewer without a browser: keeps the newest message of each kind.
class LiveClient {
 public:
  explicit LiveClient(std::uint16_t port, const std::string& target = "/live") : socket_(connected(io_, port)) {
    socket_.set_option(beast::websocket::stream_base::decorator([](beast::websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, serve::wire::kSubprotocol);
    }));
    socket_.handshake("localhost:" + std::to_string(port), target);
    socket_.binary(true);
  }

  void send(const void* data, std::size_t size) { socket_.write(boost::asio::buffer(data, size)); }
  void command(const std::string& json) {
    std::string bytes("\x11\0\0\0\0\0\0\0", 8);
    bytes += json;
    send(bytes.data(), bytes.size());
  }
  void hand(float depth, float speed) {
    struct {
      std::uint32_t kind = 16, number = 0;
      float values[5]{};
    } message;
    message.values[0] = depth;
    message.values[1] = speed;
    send(&message, sizeof message);
  }

  /// Reads messages until a condition holds. @return false if it does not hold within a minute
  bool until(const std::function<bool()>& is_true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!is_true()) {
      if (std::chrono::steady_clock::now() > end) return false;
      read();
    }
    return true;
  }
  /// Takes the needle, which nobody holds.
  bool take() {
    command(R"({"do":"take"})");
    return until([&] { return status.value("you_hold", false); });
  }
  /// Moves the needle with the hand to a depth [mm]. As a page does, it says so again after its hand was stopped: a
  /// client that was not read for a second counts as silent.
  bool go_to(float depth, float speed = 100.0F) {
    hand(depth, speed);
    return until([&] {
      if (std::exchange(went_on_, false)) hand(depth, speed);
      return std::abs(depth_mm - depth) < 0.1F;
    });
  }
  /// Waits for so much of the simulated time [s].
  bool passes(double seconds) {
    return until([&, then = time_s] { return time_s > then + seconds; });
  }
  /// Looks at a recording, until its picture is there.
  bool replay(const std::string& name) {
    command(R"({"do":"replay","name":")" + name + "\"}");
    return until([&] { return status.value("mode", "") == "replay" && (bits & 2U) != 0; });
  }
  bool back_to_live() {
    command(R"({"do":"live"})");
    return until([&] { return status.value("mode", "") == "live" && (bits & 2U) == 0; });
  }
  /// Waits until there are this many notices. @return the text of the last one
  std::string notice(std::size_t count = 1) {
    EXPECT_TRUE(until([&] { return notices.size() >= count; }));
    return notices.back()["text"];
  }
  /// The name of the recording that is being written; empty if there is none.
  [[nodiscard]] std::string recording() const {
    return status.contains("recording") ? status["recording"].value("name", "") : "";
  }
  void read() {
    beast::flat_buffer buffer;
    socket_.read(buffer);
    const auto* bytes = static_cast<const char*>(buffer.cdata().data());
    const std::size_t size = buffer.size();
    ASSERT_GE(size, 8u);
    const auto kind = at<std::uint32_t>(bytes, 0);
    const auto number = at<std::uint32_t>(bytes, 4);
    EXPECT_EQ(number, received++) << "messages are numbered";
    received_bytes += size;
    if (kind == 1) {
      scene = nlohmann::json::parse(bytes + 20, bytes + 20 + at<std::uint32_t>(bytes, 8));
      scene_nodes = at<std::uint32_t>(bytes, 12);
      ++scenes;
    } else if (kind == 2) {
      time_s = at<double>(bytes, 8);
      bits = at<std::uint32_t>(bytes, 16);
      depth_mm = at<float>(bytes, 44);
      force_N = at<float>(bytes, 48);
      most_N = std::max(most_N, force_N);
      samples = at<std::uint32_t>(bytes, 156);
      resting = at<std::uint32_t>(bytes, 164);
      displaced_nodes = at<std::uint32_t>(bytes, 160);
      ++frames;
    } else if (kind == 3) {
      status = nlohmann::json::parse(bytes + 8, bytes + size);
      if (status.value("hand_stopped", false) && answers) {
        command(R"({"do":"go_on"})");
        went_on_ = true;
      }
    } else if (kind == 4) {
      events.push_back(nlohmann::json::parse(bytes + 8, bytes + size));
    } else if (kind == 5) {
      notices.push_back(nlohmann::json::parse(bytes + 8, bytes + size));
    } else if (kind == 6) {
      map = nlohmann::json::parse(bytes + 8, bytes + size);
    } else if (kind == 7) {
      plan = nlohmann::json::parse(bytes + 8, bytes + size);
    } else if (kind == 8) {
      implant = nlohmann::json::parse(bytes + 8, bytes + size);
    } else if (kind == 9) {
      seeds = nlohmann::json::parse(bytes + 8, bytes + size);
    } else if (kind == 10) {
      dose_points = at<std::uint32_t>(bytes, 8) * at<std::uint32_t>(bytes, 12) * at<std::uint32_t>(bytes, 16);
      EXPECT_EQ(size, 40u + 2u * dose_points);
    } else if (kind == 11) {
      const auto length = at<std::uint32_t>(bytes, 8);
      const std::size_t values = std::size_t{at<std::uint32_t>(bytes, 12)} * at<std::uint32_t>(bytes, 16);
      ASSERT_EQ(size, 20u + length + values);
      image = nlohmann::json::parse(bytes + 20, bytes + 20 + length);
      pixels.assign(bytes + 20 + length, bytes + size);
      ++images;
    }
    constexpr std::array answered{2U, 3U, 9U, 10U, 11U};
    if (answers && std::ranges::find(answered, kind) != answered.end()) seen(number);
  }
  /// Says that all messages up to this one have been taken up.
  void seen(std::uint32_t number) {
    const std::array<std::uint32_t, 3> message{18, 0, number};
    send(message.data(), sizeof message);
  }
  [[nodiscard]] bool ready() const { return status.value("state", "") == "ready" && frames > 0; }
  [[nodiscard]] bool has_event(const std::string& kind) const {
    return std::any_of(events.begin(), events.end(), [&](const auto& e) { return e["kind"] == kind; });
  }

  nlohmann::json scene = nlohmann::json::object();
  nlohmann::json status = nlohmann::json::object();
  nlohmann::json map = nlohmann::json::object();
  nlohmann::json plan = nlohmann::json::object();
  nlohmann::json implant = nlohmann::json::object();
  nlohmann::json seeds = nlohmann::json::object();
  nlohmann::json image = nlohmann::json::object();
  std::vector<unsigned char> pixels;  // of the newest image
  std::vector<nlohmann::json> events, notices;
  std::uint32_t received = 0, scenes = 0, frames = 0, images = 0, bits = 0, samples = 0, displaced_nodes = 0,
                scene_nodes = 0, dose_points = 0;
  std::uint32_t resting = 0;  // needles that rest in the tissue
  bool answers = true;        // as a page does: says what it has taken up, and goes on after its hand was stopped
  std::size_t received_bytes = 0;
  double time_s = 0.0;
  float depth_mm = 0.0F, force_N = 0.0F, most_N = 0.0F;

 private:
  template <class T>
  static T at(const char* bytes, std::size_t place) {
    T value{};
    std::memcpy(&value, bytes + place, sizeof value);
    return value;
  }
  bool went_on_ = false;  // after the server had stopped its hand
  boost::asio::io_context io_;
  beast::websocket::stream<tcp::socket> socket_;
};

}  // namespace stylet::test
