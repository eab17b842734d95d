// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "library_messages.hpp"
#include "realtime/runner_parts.hpp"
#include "stylet/igtl/link.hpp"

#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlServerSocket.h>
#include <igtlStringMessage.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace stylet::test {

/// The other side of a link, with the sockets and messages of the OpenIGTLink library.
class Peer {
 public:
  /// A received message with a correct checksum.
  struct Message {
    std::string type;
    std::string name;
    Raw body;
  };

  explicit Peer(::igtl::ClientSocket::Pointer socket) : socket_(std::move(socket)) {
    if (!socket_) throw std::runtime_error("nobody connected");
    std::signal(SIGPIPE, SIG_IGN);  // the library's sockets raise it when the other side has disconnected
    socket_->SetReceiveTimeout(60'000);
  }
  static Peer to(int port) {
    auto socket = ::igtl::ClientSocket::New();
    if (socket->ConnectToServer("127.0.0.1", port) != 0) throw std::runtime_error("no connection");
    return Peer(socket);
  }

  bool send(const Raw& bytes) { return socket_->Send(bytes.data(), static_cast<int>(bytes.size())) != 0; }

  /// The next message; empty if the other side has closed the connection.
  std::optional<Message> next() {
    auto header = ::igtl::MessageHeader::New();
    header->InitPack();
    if (socket_->Receive(header->GetPackPointer(), header->GetPackSize()) != header->GetPackSize()) return {};
    header->Unpack();
    auto message = ::igtl::MessageBase::New();
    message->SetMessageHeader(header);
    message->AllocatePack();
    const int size = message->GetPackBodySize();
    if (size > 0 && socket_->Receive(message->GetPackBodyPointer(), size) != size) return {};
    if ((message->Unpack(1) & ::igtl::MessageBase::UNPACK_BODY) == 0) throw std::runtime_error("wrong checksum");
    const auto* first = static_cast<const std::uint8_t*>(message->GetPackBodyPointer());
    return Message{header->GetDeviceType(), header->GetDeviceName(), Raw(first, first + size)};
  }

  /// The next message of this type and name that satisfies a condition; empty if there is none.
  std::optional<Message> next(const std::string& type, const std::string& name,
                              const std::function<bool(const Message&)>& wanted = {}) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < until) {
      auto message = next();
      if (!message) return {};
      if (message->type == type && message->name == name && (!wanted || wanted(*message))) return message;
    }
    return {};
  }

  /// Whether the other side closes the connection; messages before that are skipped.
  bool closes() {
    while (next()) {
    }
    return true;
  }
  void close() { socket_->CloseSocket(); }

 private:
  ::igtl::ClientSocket::Pointer socket_;
};

/// Elements of a TRANSFORM, big-endian on the wire.
inline std::array<float, 12> matrix_of(const Peer::Message& m) {
  std::array<float, 12> values{};
  EXPECT_EQ(m.body.size(), sizeof values);
  for (std::size_t k = 0; k < values.size(); ++k) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 4; ++b) bits = (bits << 8) | m.body.at(4 * k + b);
    std::memcpy(&values[k], &bits, sizeof bits);
  }
  return values;
}
/// Force and torque of an NDARRAY of six doubles.
inline std::array<double, 6> wrench_of(const Peer::Message& m) {
  std::array<double, 6> values{};
  EXPECT_EQ(m.body.size(), 4 + sizeof values);
  for (std::size_t k = 0; k < values.size(); ++k) {
    std::uint64_t bits = 0;
    for (std::size_t b = 0; b < 8; ++b) bits = (bits << 8) | m.body.at(4 + 8 * k + b);
    std::memcpy(&values[k], &bits, sizeof bits);
  }
  return values;
}
inline std::string text_of(const Peer::Message& m) { return {m.body.begin() + 4, m.body.end()}; }
inline int code_of(const Peer::Message& m) { return 256 * m.body.at(0) + m.body.at(1); }

/// A different port for every test.
inline stylet::igtl::LinkSettings any_port() {
  stylet::igtl::LinkSettings s;
  s.port = 0;
  return s;
}
inline std::unique_ptr<stylet::igtl::Link> opened(const stylet::igtl::LinkSettings& settings) {
  auto link = stylet::igtl::Link::open(settings);
  if (!link) throw std::runtime_error(link.error().message());
  return std::move(*link);
}

/// Calls a function repeatedly in a thread of its own.
class Repeat {
 public:
  explicit Repeat(std::function<void()> what)
      : thread_([this, what = std::move(what)] {
          while (!stop_) {
            what();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}
  ~Repeat() {
    stop_ = true;
    thread_.join();
  }
  Repeat(const Repeat&) = delete;
  Repeat& operator=(const Repeat&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Initialises the library's list of message types, which it otherwise makes at the first message without a lock.
inline const bool kLibraryReady = [] {
  library_transform("", at(0, 0, 0));
  return true;
}();

}  // namespace stylet::test
