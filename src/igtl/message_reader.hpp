// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "incoming.hpp"
#include "stylet/core/result.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace stylet::igtl {

/// Decodes messages from the bytes of a connection, in pieces of any size. The bytes are not trusted: the length in the
/// header is checked before the body is stored, and only bodies of at most kKept bytes are stored. Bodies of other
/// types are skipped. Reads header versions 1 and 2 (protocols 1 to 3); skips metadata. A message that is complete but
/// cannot be used is passed on as Incoming::Kind::refused, and the next one is read.
class MessageReader {
 public:
  static constexpr std::size_t kKept = 65536;  ///< [bytes] longest body that is used
  struct Options {
    std::uint64_t longest = std::uint64_t{1} << 28;  ///< [bytes] longest body of any type; large, because of images
    bool checksums = true;                           ///< whether a body has to match its checksum
  };
  MessageReader() = default;
  explicit MessageReader(const Options& options) : options_(options) {}

  /// Decodes the next bytes and passes complete messages to `sink`.
  /// @return an error if the bytes are not a message; where the next message starts is then unknown, so the connection
  /// must be closed
  Result<> take(std::span<const std::uint8_t> bytes, const std::function<void(const Incoming&)>& sink);
  /// Whether only a part of a message has been received.
  [[nodiscard]] bool is_inside() const { return header_filled_ > 0; }

 private:
  Result<> read_header();
  void read_body();
  void read_content(std::span<const std::uint8_t> content);
  void refuse(const char* kind, std::string why, std::string cure);

  Options options_;
  std::array<std::uint8_t, 58> header_{};
  std::size_t header_filled_ = 0;
  Incoming message_;
  std::uint16_t version_ = 0;
  std::uint64_t crc_ = 0;
  std::uint64_t body_left_ = 0;  ///< bytes of the body that have not been received
  bool keep_ = false;
  std::vector<std::uint8_t> body_;
};

}  // namespace stylet::igtl
