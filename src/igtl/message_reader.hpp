// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "ras.hpp"
#include "stylet/core/result.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace stylet::igtl {

/// The parts of a received message that a link uses.
struct Incoming {
  enum class Kind { pose, status, token, other } kind = Kind::other;
  std::string type;  ///< as sent, such as "TRANSFORM" or "POSITION"
  std::string name;
  RasMatrix matrix{};      ///< of a pose
  std::uint16_t code = 0;  ///< of a STATUS; 1 means OK
  std::string text;        ///< of a token
};

/// Name of the STRING with which a program gives the token.
inline constexpr const char* kTokenName = "Token";

/// Decodes messages from the bytes of a connection, in pieces of any size. The bytes are not trusted: the length in the
/// header is checked before the body is stored, and only bodies of at most kKept bytes are stored. Bodies of other
/// types are skipped. Reads header versions 1 and 2 (protocols 1 to 3); skips metadata. A POSITION is given as the
/// TRANSFORM of the same pose; one without an orientation is passed on as another message.
class MessageReader {
 public:
  static constexpr std::size_t kKept = 65536;
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

 private:
  Result<> read_header();
  Result<> read_body(Incoming& message);

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
